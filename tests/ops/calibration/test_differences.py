"""Any two calibrations beside each other, what a version is from, and what was made under it."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.management import CommandError, call_command
from django.test import Client

from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.models import AppendOnlyError, Calibration, CalibrationPlacement, Dataset, Job
from gtm_hit.ops.calibration import differences, sides, versions
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.calibration.replacing import preview, replace_calibration
from gtm_hit.ops.calibration.reports import sections
from gtm_hit.ops.calibration.usage import placings
from gtm_hit.ops.datasets.importing import import_dataset
from gtm_hit.ops.desk.errors import DeskError
from tests.calibration.test_comparing import moved
from tests.dataset_folder import cameras, make_folder, options
from tests.desk_scene import click, make_desk, seen
from tests.ops.calibration.test_replace_calibration import no_progress, shifted
from tests.ops.calibration.test_versions import put, save

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_folders(settings: Any, tmp_path: Path) -> None:
    for name in ("MEDIA", "TABLES", "EXPORTS", "UPLOADS"):
        setattr(settings, f"{name}_ROOT", tmp_path / name.lower())


@pytest.fixture
def dataset(tmp_path: Path) -> Dataset:
    return import_dataset(options(make_folder(tmp_path / "square"))).dataset


def carried() -> list:
    """The first camera 5 cm along the ground."""
    return [moved(cameras()[0], (0.03, 0.04, 0.0)), *cameras()[1:]]


def compared(dataset: Dataset, before: str, after: str, **values: Any) -> dict[str, Any]:
    both = (sides.side(dataset, key) for key in (before, after))
    return differences.content(differences.difference(dataset, *both, **values))


# Two beside each other


def test_two_versions_differ_by_what_was_changed_whichever_is_in_use(dataset: Dataset) -> None:
    put(dataset, shifted(7.0))
    put(dataset, cameras())
    put(dataset, carried())
    told = compared(dataset, "2", "3")
    first, second, third = told["cameras"]
    assert (first["centre_cm"], first["ground_cm"]["median"]) == pytest.approx((5.0, 5.0))
    assert second["before"]["cx"] - second["after"]["cx"] == pytest.approx(7.0)
    assert second["boxes"]["max"] == 7 and third["boxes"]["max"] == 0
    assert told["annotations"] == told["compared"] == 5
    flat = [value for row in told["ground"]["worst_cm"] for value in row if value is not None]
    assert max(flat) > 4.9 and len(told["ground"]["worst_cm"]) == told["ground"]["rows"]


def test_boxes_of_many_annotations_are_those_of_an_even_part(dataset: Dataset) -> None:
    put(dataset, shifted())
    told = compared(dataset, "1", "2", most=2)
    assert told["annotations"] == 5 and 1 <= told["compared"] <= 2


def test_what_was_only_compared_can_be_looked_at_and_is_offered(dataset: Dataset) -> None:
    job = calibration_job.start(dataset, carried(), source="new.json")
    assert [choice.key for choice in sides.choices(dataset)] == ["1", f"job:{job.pk}"]
    assert compared(dataset, "1", f"job:{job.pk}")["cameras"][0]["centre_cm"] == pytest.approx(5.0)


def test_a_desk_is_compared_as_it_is_now_and_offered_when_it_is_complete() -> None:
    desk = make_desk()
    dataset = desk.dataset
    assert dataset is not None
    versions.put_in_place(dataset, dataset.calibrated_cameras(), "import")
    with pytest.raises(DeskError, match="No place on the ground yet: C1, C2"):
        sides.side(dataset, "desk:plaza")
    for camera in ("C1", "C2"):
        click(desk, " ".join(seen(desk, camera)), camera)
    assert [choice.key for choice in sides.choices(dataset)] == ["1", "desk:plaza"]
    told = compared(dataset, "1", "desk:plaza")
    assert 0 < told["cameras"][0]["centre_cm"] < 5


@pytest.mark.parametrize("key", ["9", "desk:nowhere", "job:9", "job:x", "", "import"])
def test_what_there_is_not_cannot_be_compared(dataset: Dataset, key: str) -> None:
    with pytest.raises((sides.UnknownSide, versions.UnknownVersion), match="square has no calibration"):
        sides.side(dataset, key)


def test_a_job_of_another_dataset_is_none_of_this_one(dataset: Dataset) -> None:
    other = Dataset.objects.create(slug="other", name="Other")
    job = calibration_job.start(other, carried())
    with pytest.raises(sides.UnknownSide):
        sides.side(dataset, f"job:{job.pk}")


# What a version is from


def placed(dataset: Dataset, new: list, source: str, report: dict[str, Any]) -> Calibration:
    return replace_calibration(dataset, new, preview(dataset, new, no_progress), source, report=report)


def test_two_desks_with_the_same_numbers_keep_both_reports(dataset: Dataset) -> None:
    first = placed(dataset, shifted(), "desk one", {"desk": "one", "step": 1})
    second = placed(dataset, shifted(), "desk two", {"desk": "two", "step": 2})
    assert first == second and first.report["desk"] == "one"
    assert [each.source for each in placings(first)] == ["desk one", "desk two"]
    assert [each.sections[0].facts[0].value for each in placings(first)] == ["one", "two"]


def test_going_back_is_kept_with_its_time_and_who_did_it(dataset: Dataset) -> None:
    put(dataset, shifted())
    job = calibration_job.start_version(dataset, 1)
    Job.objects.filter(pk=job.pk).update(
        state=Job.State.DONE, result=preview(dataset, cameras(), no_progress)
    )
    calibration_job.confirm(job, User.objects.create_user("sam"))
    again = placings(versions.version(dataset, 1))[-1]
    assert (again.source, str(again.by)) == ("version 1", "sam")
    with pytest.raises(AppendOnlyError):
        CalibrationPlacement.objects.get().save()


def test_a_report_of_before_and_one_with_an_adjustment_are_told() -> None:
    adjust = {
        "variant": "soft",
        "cost": 17917.84,
        "hold_out": {"median_px": 4.86},
        "cameras": [{"name": "C1", "before": {"median": 2.2}, "after": {"median": 0.9}, "moved": 0.06}],
        "notices": ["1 point was left out."],
    }
    assert sections({}) == []
    (told,) = sections({"adjust": adjust})
    assert told.rows[0][:3] == ["C1", "2.20", "0.90"] and told.notes == ["1 point was left out."]
    assert {fact.name: fact.value for fact in told.facts}["One view left out, median"] == "4.86 px"


# The page, REST and the command


def test_the_page_of_a_version_tells_the_file_it_came_as_and_what_was_made_under_it(
    client: Client, dataset: Dataset, tmp_path: Path
) -> None:
    client.force_login(User.objects.create_user("sam", is_superuser=True))
    save_cameras(tmp_path / "new.json", shifted())
    call_command(
        "replacecalibration", "square", str(tmp_path / "new.json"), "--confirm", stdout=io.StringIO()
    )
    save(dataset)
    page = client.get("/datasets/square/calibration/versions/2/").content.decode()
    assert "SHA-256" in page and "new.json" in page and "1 save, in 1 layers" in page
    assert "go back to it" not in page
    assert "go back to it" in client.get("/datasets/square/calibration/versions/1/").content.decode()
    assert client.get("/datasets/square/calibration/versions/9/").status_code == 404


def test_the_page_draws_the_shift_and_says_what_cannot_be_compared(client: Client, dataset: Dataset) -> None:
    client.force_login(User.objects.create_user("sam", is_superuser=True))
    address = "/datasets/square/calibration/differences/"
    assert "only one calibration yet" in client.get(address).content.decode()
    put(dataset, carried())
    page = client.get(address).content.decode()  # what is in use beside the other one
    assert 'class="shift-4" d="M' in page and "median 5.0 cm" in page
    assert "has no calibration 9" in client.get(f"{address}?before=1&after=9").content.decode()


def test_rest_tells_the_same_and_names_what_it_does_not_know(client: Client, dataset: Dataset) -> None:
    client.force_login(User.objects.create_user("sam", is_superuser=True))
    put(dataset, carried())
    address = "/api/v1/datasets/square/calibrations/differences/"
    told = client.get(f"{address}?before=1&after=2").json()
    assert told == json.loads(json.dumps(compared(dataset, "1", "2")))
    refused = client.get(f"{address}?before=1&after=9")
    assert refused.status_code == 400 and "has no calibration 9" in refused.content.decode()
    whole = client.get("/api/v1/datasets/square/calibrations/versions/1/").json()
    assert whole["made_under_it"]["saves"] > 0 and whole["placements"] == []


def command(*words: str) -> str:
    out = io.StringIO()
    call_command("replacecalibration", "square", *words, stdout=out)
    return out.getvalue()


def test_the_command_compares_versions_and_files(dataset: Dataset, tmp_path: Path) -> None:
    save_cameras(tmp_path / "new.json", carried())
    told = json.loads(command("--compare", "1", str(tmp_path / "new.json"), "--json"))
    assert told["cameras"][0]["centre_cm"] == pytest.approx(5.0)
    assert "from version 1 to new.json" in command("--compare", "1", str(tmp_path / "new.json"))
    assert "calibration 1, in place" in command("--show", "1")
    for words in (["--compare", "1", "9"], ["--show", "9"]):
        with pytest.raises(CommandError, match="has no calibration 9"):
            command(*words)


def test_cameras_of_other_names_are_not_compared(dataset: Dataset) -> None:
    one = sides.side(dataset, "1")
    other = replace(one, cameras=[replace(camera, name=f"X{camera.name}") for camera in one.cameras])
    with pytest.raises(differences.NotComparable, match="the other XC1"):
        differences.difference(dataset, one, other)
