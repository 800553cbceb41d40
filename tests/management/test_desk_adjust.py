"""`calibrationdesk D --adjust` as a process, from clicks to cameras."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.models import Desk, DeskAdjustment
from gtm_hit.ops.desk import placing
from tests.adjust_scene import noisy_desk
from tests.management.test_calibrationdesk import run

pytestmark = pytest.mark.django_db


def test_a_desk_is_adjusted_used_and_written_by_one_command(tmp_path: Path, settings: Any) -> None:
    settings.UPLOADS_ROOT = tmp_path / "uploads"
    desk = noisy_desk()
    out, problem = tmp_path / "cameras.json", tmp_path / "ba_problem.txt"
    before = placing.cameras(desk)
    told = run(
        *("plaza", "--adjust", "--variant", "fixed", "--hold", "C1:pose", "--use-result"),
        *("--cameras-json", out, "--ba-problem", problem, "--json"),
    )
    facts = json.loads(told.splitlines()[-1])["adjust"]
    assert facts["in_use"] == 1 and facts["results"][0]["choices"]["hold"] == ["C1:pose"]
    after = load_cameras(out)
    assert after[0].centre == pytest.approx(before[0].centre, abs=1e-9)
    assert after[1].centre != pytest.approx(before[1].centre, abs=1e-4)
    assert problem.read_text().startswith("4 40 ")
    assert "Each" not in run("plaza", "--leave-result")
    assert placing.cameras(Desk.objects.get())[1].centre.tolist() == before[1].centre.tolist()


def test_a_click_is_dropped_by_its_name() -> None:
    noisy_desk()
    run("plaza", "--drop", "kept", "P1", "C1", "--adjust")
    clicks = DeskAdjustment.objects.get().inputs["clicks"]
    assert not any(each[:3] == ["kept", "P1", "C1"] for each in clicks)
