from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import pytest
from django.core.management import call_command
from django.core.management.base import CommandError

from gtm_hit.formats.calibration.cameras_json import load_cameras, save_cameras
from gtm_hit.models import Desk
from tests.check_scene import LAMP, calibrated_desk, true_clicks
from tests.desk_scene import make_desk, seen

pytestmark = pytest.mark.django_db


def run(*words: object, **options: Any) -> str:
    stream = io.StringIO()
    call_command("calibrationdesk", *map(str, words), stdout=stream, **options)
    return stream.getvalue()


def test_a_desk_from_nothing_to_cameras_by_files_alone(tmp_path: Path, settings: Any) -> None:
    settings.UPLOADS_ROOT = tmp_path / "uploads"
    model = make_desk()
    assert model.dataset is not None
    (tmp_path / "points.csv").write_text(
        "name,x,y\n" + "".join(f"{each.name},{each.x},{each.y}\n" for each in model.points.all())
    )
    pairs = [{"name": name, "pixel": list(place)} for name, place in seen(model).items()]
    (tmp_path / "clicks.json").write_text(json.dumps({"pairs": pairs}))
    save_cameras(tmp_path / "lens.json", model.dataset.calibrated_cameras()[:1])
    out = tmp_path / "cameras.json"
    told = run(
        *("yard", "--new", "--cameras", "C1", "--points", tmp_path / "points.csv", "--unit", "m"),
        *("--lens", "C1", tmp_path / "lens.json", "--clicks", "C1", tmp_path / "clicks.json"),
        *("--cameras-json", out, "--json"),
    )
    found = json.loads(told)
    assert found["points"] == 15 and found["cameras"][0]["rms"] < 0.5
    truth = model.dataset.calibrated_cameras()[0]
    assert load_cameras(out)[0].centre == pytest.approx(truth.centre, abs=0.05)


def test_without_a_name_all_desks_are_listed() -> None:
    make_desk()
    assert "plaza for square: Click points in C1." in run()


def test_a_desk_that_is_not_there_is_refused_and_those_there_are_named() -> None:
    make_desk()
    with pytest.raises(CommandError, match="there are: plaza"):
        run("yard")


def test_a_broken_file_changes_nothing(tmp_path: Path) -> None:
    make_desk()
    (tmp_path / "points.csv").write_text("name,x,y\nA,one,2\n")
    with pytest.raises(CommandError, match="line 2"):
        run("plaza", "--points", tmp_path / "points.csv", "--unit", "m")
    assert Desk.objects.get().points.count() == 15


def test_kept_points_go_in_and_out_by_files_and_are_judged(tmp_path: Path) -> None:
    desk = calibrated_desk()
    lines = [f"lamp,{each.camera},{each.x},{each.y}" for each in true_clicks(LAMP)]
    (tmp_path / "clicks.csv").write_text("\n".join(lines))
    out = tmp_path / "kept.csv"
    told = run("plaza", "--kept", tmp_path / "clicks.csv", "--kept-out", out)
    assert "check           usable      1 test point: median 0.0 px" in told
    found = json.loads(run("plaza", "--undo", "check", "--json"))
    assert found["kept"] == [] and not desk.kept_points.exists()
    found = json.loads(run("plaza", "--kept", out, "--json"))
    assert found["kept"][0]["place"] == pytest.approx(LAMP, abs=1e-3)
    assert found["summaries"]["test"]["clicks"] == 7
    with pytest.raises(CommandError, match="a kept point lamp already"):
        run("plaza", "--kept", out)
