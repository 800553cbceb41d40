"""What the table does not say: where people land, what pages offer, what is among the jobs and sources."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.files.uploadedfile import SimpleUploadedFile
from django.test import Client

from gtm_hit.models import Dataset, Job, Layer, Save
from gtm_hit.ops import api_tokens
from gtm_hit.ops.access.jobs import jobs_of
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.jobs import queue
from tests.access.scene import somebody
from tests.api.conftest import body
from tests.conftest import REPOSITORY
from tests.work_scene import make_dataset, make_layer, row

pytestmark = pytest.mark.django_db

TABS = {
    Role.REVIEWER: {"layers", "compare", "statistics", "releases"},
    Role.MANAGER: {"batches", "layers", "compare", "statistics", "releases"},
    Role.MAINTAINER: {"layers", "calibration", "compare", "statistics", "releases"},
    Role.ADMINISTRATOR: {"batches", "layers", "calibration", "compare", "statistics", "releases", "people"},
}


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, settings: Any) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"
    settings.INCOMING_ROOT, settings.UPLOADS_ROOT = tmp_path / "incoming", tmp_path / "uploads"
    (tmp_path / "incoming" / "plaza").mkdir(parents=True)


@pytest.fixture
def dataset() -> Dataset:
    return make_dataset(images=True)


def signed_in(role: Role | None, dataset: Dataset | None = None) -> Client:
    client = Client()
    client.force_login(somebody(f"a-{role}", role, dataset))
    return client


def text(answer: Any) -> str:
    return answer.content.decode()


@pytest.mark.parametrize("role", [Role.REVIEWER, Role.MANAGER, Role.MAINTAINER, Role.ADMINISTRATOR])
def test_home_leads_who_sees_a_dataset_to_the_datasets(dataset: Dataset, role: Role) -> None:
    assert signed_in(role, dataset).get("/")["Location"] == "/datasets/"


def test_home_leads_an_annotator_to_no_dataset(dataset: Dataset) -> None:
    answer = signed_in(Role.ANNOTATOR, dataset).get("/")
    assert "datasets" not in answer.get("Location", "") and "/datasets/" not in text(answer)


def test_home_tells_who_has_no_role_yet_whom_to_ask() -> None:
    page = text(signed_in(None).get("/"))
    assert "An administrator gives it a role" in page and "/datasets/" not in page


@pytest.mark.parametrize("role", TABS)
def test_a_dataset_shows_the_tabs_that_open(dataset: Dataset, role: Role) -> None:
    client = signed_in(role, dataset)
    page = text(client.get("/datasets/square/"))
    names = {"batches", "layers", "calibration", "compare", "statistics", "releases", "people"}
    shown = {name for name in names if f'href="/datasets/square/{name}/"' in page}
    assert shown == TABS[role]
    assert all(client.get(f"/datasets/square/{name}/").status_code == 200 for name in shown)


def test_the_bar_shows_all_peoples_roles_to_administrators_of_all_only(dataset: Dataset) -> None:
    assert 'href="/people/"' in text(signed_in(Role.ADMINISTRATOR).get("/datasets/"))
    one = Client()
    one.force_login(somebody("local", Role.ADMINISTRATOR, dataset))
    assert 'href="/people/"' not in text(one.get("/datasets/"))


@pytest.mark.parametrize("role", list(Role))
def test_djangos_admin_opens_to_no_role(dataset: Dataset, role: Role) -> None:
    client = signed_in(role)
    for address in ("", "gtm_hit/annotation/", "gtm_hit/membership/", "auth/user/"):
        assert client.get(f"/admin/{address}")["Location"].startswith("/admin/login/")


def test_being_staff_is_asked_for_by_nobody_but_djangos_admin() -> None:
    files = [*(REPOSITORY / "gtm_hit").rglob("*.py"), *(REPOSITORY / "templates").rglob("*.html")]
    asking = {str(file.relative_to(REPOSITORY)) for file in files if "is_staff" in file.read_text()}
    # The migration makes administrators of staff, the bar links to the admin.
    assert asking == {
        "gtm_hit/migrations/0010_roles.py",
        "gtm_hit/ops/access/roles.py",
        "templates/base.html",
    }


def test_jobs_are_those_one_could_start(dataset: Dataset) -> None:
    layer, truth = make_layer(dataset), make_layer(dataset, "truth", hidden=True)
    jobs = {
        "export": exporting.start(layer),
        "export of the truth": exporting.start(truth),
        "import": queue.create(Job.Kind.IMPORT_ANNOTATIONS, dataset, {}),
        "import of a new dataset": queue.create(Job.Kind.IMPORT_DATASET, None, {}),
        "elsewhere": exporting.start(make_layer(make_dataset("other"))),
    }
    names = {job.pk: name for name, job in jobs.items()}

    def seen(user: User) -> set[str]:
        return {names[job.pk] for job in jobs_of(user)}

    assert seen(somebody("r", Role.REVIEWER, dataset)) == set()
    assert seen(somebody("m", Role.MANAGER, dataset)) == {"export", "export of the truth"}
    assert seen(somebody("n", Role.MAINTAINER, dataset)) == {"export", "import"}
    everywhere = seen(somebody("o", Role.MAINTAINER))
    assert everywhere == set(jobs) - {"export of the truth"}
    assert seen(somebody("a", Role.ADMINISTRATOR)) == set(jobs)


def test_a_maintainer_of_one_dataset_brings_frames_into_that_one_only(dataset: Dataset) -> None:
    make_dataset("other")
    client = signed_in(Role.MAINTAINER, dataset)
    for slug in ("other", "new-one"):
        answer = client.post("/api/v1/imports/", {"source": "x", "slug": slug}, "application/json")
        assert (answer.status_code, answer.json()["details"][0]["place"]) == (400, "slug")
    answer = client.post("/api/v1/imports/", {"source": "x", "slug": "square"}, "application/json")
    assert answer.json()["details"][0]["place"] == "source"


def test_the_import_page_refuses_another_dataset(dataset: Dataset) -> None:
    client = signed_in(Role.MAINTAINER, dataset)
    archive = SimpleUploadedFile("a.zip", b"PK")
    page = text(client.post("/imports/", {"slug": "new-one", "preset": "wildtrack", "archive": archive}))
    assert "You look after no dataset new-one" in page
    assert not Job.objects.exists()


def test_what_lies_on_the_server_is_offered_to_maintainers_of_all_datasets_only(dataset: Dataset) -> None:
    local, general = signed_in(Role.MAINTAINER, dataset), Client()
    general.force_login(somebody("general", Role.MAINTAINER))
    for address in ("/imports/", "/datasets/square/import-annotations/"):
        assert "incoming/plaza" in text(general.get(address))
        assert 'value="incoming/plaza"' not in text(local.get(address))
    wanted = {"source": "incoming/plaza", "format": "csv", "layer": "theirs"}
    address = "/api/v1/datasets/square/annotation-imports/"
    assert local.post(address, wanted, "application/json").status_code == 400
    assert general.post(address, wanted, "application/json").status_code == 202


@pytest.mark.parametrize("kind", [Layer.Kind.IMPORTED, Layer.Kind.GROUND_TRUTH])
def test_reviewers_change_nothing_that_others_are_measured_by(dataset: Dataset, kind: Layer.Kind) -> None:
    layer = make_layer(dataset, "kept", kind)
    address = f"/api/v1/layers/{layer.pk}/frames/5/"
    refused = signed_in(Role.REVIEWER, dataset).put(address, body(people=[row()]), "application/json")
    assert (refused.status_code, Save.objects.count()) == (403, 0)
    taken = signed_in(Role.MAINTAINER, dataset).put(address, body(people=[row()]), "application/json")
    assert taken.status_code == 200


def test_a_comparison_of_calibrations_shows_no_people_of_the_hidden_truth(dataset: Dataset) -> None:
    make_layer(dataset, "truth", hidden=True)
    job = queue.create(Job.Kind.REPLACE_CALIBRATION, dataset, {})
    moved = [{"layer": "truth", "person": 1}, {"layer": "seen", "person": 2}]
    boxes = [[[1, 2, 3, 4]], []]
    job.result = {"worst": moved, "picture": {"layer": "truth", "before": boxes, "after": boxes}}
    found = calibration_job.seen_by(somebody("m", Role.MAINTAINER, dataset), job)
    assert [each["person"] for each in found["worst"]] == [2]
    assert found["picture"] == {"layer": None, "before": [[], []], "after": [[], []]}
    assert calibration_job.seen_by(somebody("a", Role.ADMINISTRATOR), job) == job.result


def test_annotators_make_no_tokens(dataset: Dataset) -> None:
    with pytest.raises(api_tokens.TokenError):
        api_tokens.make(somebody("anna", Role.ANNOTATOR, dataset), "x", ["read"])


def test_pages_cost_two_questions_about_roles_however_many_one_has(
    dataset: Dataset, django_assert_num_queries: Any
) -> None:
    user = somebody("busy", Role.MANAGER, dataset)
    client = Client()
    client.force_login(user)
    client.get("/datasets/square/layers/")
    with django_assert_num_queries(8):
        client.get("/datasets/square/layers/")
