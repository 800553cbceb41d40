"""A lens from pictures of a board: sent, searched as a job, chosen, solved, switched."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from gtm_hit.calibration.boards import Board, BoardKind
from gtm_hit.calibration.lens_models import Coefficients, LensModel
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.demo.boards import board_picture, placements
from gtm_hit.models import BoardPicture, Desk, DeskCamera, Job
from gtm_hit.ops.desk import boards, desks, edits, lens_job, preview
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS

pytestmark = pytest.mark.django_db

BOARD = Board(BoardKind.CHESSBOARD, 7, 5, 0.04)
LENS = Lens(
    480, 270, np.array([[420.0, 0, 241], [0, 420.0, 136], [0, 0, 1]]), np.array([-0.1, 0.05, 0, 0, 0.0])
)
PAGE = edits.lens_page("C1")


@pytest.fixture(scope="module")
def files() -> list[tuple[str, bytes]]:
    """Eight pictures with the board, and one without."""
    found = []
    for number, placement in enumerate(placements(LENS, BOARD, 8, seed=3)):
        picture = board_picture(LENS, BOARD, placement, seed=number)
        found.append((f"view-{number}.png", cv2.imencode(".png", picture)[1].tobytes()))
    empty = np.full((270, 480), 127, np.uint8)
    return [*found, ("wall.png", cv2.imencode(".png", empty)[1].tobytes())]


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, settings: Any) -> None:
    settings.MEDIA_ROOT, settings.DATA_DIR = tmp_path / "media", tmp_path
    settings.UPLOADS_ROOT = tmp_path / "uploads"


@pytest.fixture
def desk() -> Desk:
    return desks.make("yard", cameras=["C1"])


def send(desk: Desk, files: list[tuple[str, bytes]], model: LensModel | None = None) -> Job:
    sent = lens_job.keep_upload([SimpleUploadedFile(name, data) for name, data in files])
    job = lens_job.start(desk, "C1", BOARD, model or LensModel(), sent)
    queue.run(job.pk, OPERATIONS)
    job.refresh_from_db()
    return job


def camera() -> DeskCamera:
    return DeskCamera.objects.get()


@pytest.fixture
def solved(desk: Desk, files: list[tuple[str, bytes]]) -> Iterator[Desk]:
    job = send(desk, files)
    assert (job.state, job.result["found"]) == (Job.State.DONE, 8), job.message
    yield desk


def test_pictures_become_a_lens_with_a_verdict(solved: Desk) -> None:
    row = camera()
    assert row.lens["matrix"][0][0] == pytest.approx(420, rel=0.01)
    assert (row.width, row.height) == (480, 270)
    assert row.lens_report["verdict"] in {"good", "usable"} and row.lens_report["words"]
    assert len(row.lens_report["views"]) == 8
    missing = BoardPicture.objects.get(name="wall.png")
    assert missing.found is None and missing.reason


def test_a_zip_is_read_like_its_files_and_gives_the_same_lens(
    solved: Desk, files: list[tuple[str, bytes]]
) -> None:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, data in files:
            archive.writestr(name, data)
    other = desks.make("other", cameras=["C1"])
    send(other, [("boards.zip", stream.getvalue())])
    one, two = DeskCamera.objects.order_by("pk")
    assert one.lens == two.lens
    assert [k for k in one.lens_report if one.lens_report[k] != two.lens_report[k]] == []


def test_a_view_switched_off_is_solved_without_and_undoing_brings_the_same_lens_back(solved: Desk) -> None:
    before = camera()
    boards.switch(solved, "C1", "view-0.png", used=False)
    after = camera()
    assert after.lens != before.lens and len(after.lens_report["views"]) == 7
    edits.undo(solved, PAGE)
    again = camera()
    assert (again.lens, again.lens_report) == (before.lens, before.lens_report)
    assert BoardPicture.objects.get(name="view-0.png").used
    edits.redo(solved, PAGE)
    assert camera().lens == after.lens


def test_too_few_views_are_refused_and_nothing_is_switched(solved: Desk) -> None:
    for number in range(5):
        boards.switch(solved, "C1", f"view-{number}.png", used=False)
    with pytest.raises(DeskError, match="3 are the least"):
        boards.switch(solved, "C1", "view-5.png", used=False)
    assert BoardPicture.objects.get(name="view-5.png").used


def test_another_model_is_solved_at_once_and_kept_for_later(solved: Desk) -> None:
    boards.use_model(solved, "C1", LensModel(Coefficients.TWO))
    assert camera().lens["distortion"][2:] == [0, 0, 0]
    boards.switch(solved, "C1", "view-0.png", used=False)
    assert camera().lens["distortion"][2:] == [0, 0, 0]


def test_a_job_that_was_stopped_goes_on_where_it_was(
    desk: Desk, files: list[tuple[str, bytes]], monkeypatch: pytest.MonkeyPatch
) -> None:
    looked: list[str] = []
    real = lens_job._found

    def found(kept: BoardPicture, board: Board, *, explain: bool) -> Any:
        looked.append(kept.name)
        if len(looked) == 4:
            raise queue.JobCancelled("stopped")
        return real(kept, board, explain=explain)

    monkeypatch.setattr(lens_job, "_found", found)
    job = send(desk, files)
    assert job.state == Job.State.CANCELLED and camera().lens is None
    again = queue.retry(job)
    queue.run(again.pk, OPERATIONS)
    assert camera().lens is not None
    assert looked[:3] == ["view-0.png", "view-1.png", "view-2.png"]
    assert len(looked) == 4 + 6, "the three that were done are not searched again"


def test_pictures_of_two_sizes_are_refused_by_name(desk: Desk, files: list[tuple[str, bytes]]) -> None:
    small = cv2.imencode(".png", np.zeros((100, 100), np.uint8))[1].tobytes()
    job = send(desk, [*files[:4], ("small.png", small)])
    assert job.state == Job.State.FAILED and "small.png" in job.message
    assert "/" not in job.message.replace("×", "")
    assert camera().lens is None and not BoardPicture.objects.exists()


def test_what_is_no_picture_is_told_and_the_others_are_used(
    desk: Desk, files: list[tuple[str, bytes]]
) -> None:
    job = send(desk, [*files[:5], ("broken.png", b"not a picture at all")])
    assert job.result["unreadable"][0]["name"] == "broken.png"
    assert job.result["found"] == 5


def test_a_board_that_is_not_in_the_pictures_gives_no_lens_and_says_so(
    desk: Desk, files: list[tuple[str, bytes]]
) -> None:
    sent = lens_job.keep_upload([SimpleUploadedFile(name, data) for name, data in files[:4]])
    job = lens_job.start(desk, "C1", Board(BoardKind.CHESSBOARD, 6, 5, 0.04), LensModel(), sent)
    queue.run(job.pk, OPERATIONS)
    job.refresh_from_db()
    assert job.state == Job.State.DONE and job.result["problem"]
    assert job.result["other"] == "7 × 5"
    assert camera().lens is None


def test_the_undistorted_picture_is_a_jpeg_of_the_same_shape(solved: Desk) -> None:
    digest = BoardPicture.objects.all()[0].full_digest
    data = preview.undistorted(solved, "C1", digest)
    assert cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR).shape[:2] == (270, 480)


def test_a_board_is_printed_as_svg_and_pdf() -> None:
    assert preview.sheet(BOARD, "svg").startswith(b"<svg")
    assert preview.sheet(BOARD, "pdf").startswith(b"%PDF")
