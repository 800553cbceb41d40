"""The lens as a job: pictures are kept, looked through one after the other, chosen, and solved.

Every picture is written down when it is done, so whoever takes the job up again goes on where it was left.
"""

from __future__ import annotations

import shutil
import zipfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from uuid import uuid4

import cv2
from django.conf import settings
from django.contrib.auth.models import User
from django.core.files.storage import default_storage
from django.core.files.uploadedfile import UploadedFile

from gtm_hit.calibration.boards import Board
from gtm_hit.calibration.detection import find_board
from gtm_hit.calibration.lens_models import LensModel
from gtm_hit.calibration.sources import SourceError, decoded, open_source
from gtm_hit.calibration.views import BoardView, NotFound, Picture
from gtm_hit.formats.files import write_bytes
from gtm_hit.formats.problems import FormatError
from gtm_hit.models import BoardPicture, Desk, DeskCamera, Job
from gtm_hit.ops.desk import boards, edits
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.desk.lenses import refuse_size
from gtm_hit.ops.desk.things import LENS, camera_of
from gtm_hit.ops.files import sources
from gtm_hit.ops.files.images import ImageError, digest_of, make_derivatives, storage_name
from gtm_hit.ops.files.picture_cleanup import pictures_in_use
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import Progress, percents

KEEPING, LOOKING, SOLVING = "keeping pictures", "looking for the board", "solving"
SHARES = {KEEPING: (0, 35), LOOKING: (35, 95), SOLVING: (95, 100)}
EXPLAINED = 12  # pictures without a board: asking what else might be in them takes long
MOST_FILES = 500
SENT = ".boards-"  # folders of what was sent; removed with other leftovers after a week


def keep_upload(files: Sequence[UploadedFile]) -> str:
    """Put pictures, one zip or one video where the job finds them; under which name. Raises DeskError."""
    if not files:
        raise DeskError("Choose the pictures, a zip of them, or a video.")
    if len(files) > MOST_FILES:
        raise DeskError(f"{len(files)} files are too many; {MOST_FILES} are the most. Send a zip of them.")
    names = [Path(file.name or "").name for file in files]
    if len(set(names)) < len(names):
        raise DeskError("Two of the files have the same name.")
    key = f"{SENT}{uuid4().hex}"
    folder = settings.UPLOADS_ROOT / key
    try:
        for name, file in zip(names, files, strict=True):
            if not name or name[0] == ".":
                raise DeskError(f"{name or 'A file without a name'} cannot be used.")
            write_bytes(folder / name, b"".join(file.chunks()))
        if len(files) == 1 and zipfile.is_zipfile(folder / names[0]):
            sources.checked_entries(folder / names[0])
    except (DeskError, FormatError) as error:
        shutil.rmtree(folder, ignore_errors=True)
        if isinstance(error, FormatError):
            raise error.relative_to(folder) from error
        raise
    return key


def start(
    desk: Desk, camera: str, board: Board, model: LensModel, sent: str = "", user: User | None = None
) -> Job:
    """Look for the board in what was sent and in the pictures that are there. Raises DeskError."""
    row = camera_of(desk, camera)
    if not sent and not row.board_pictures.exists():
        raise DeskError("There are no pictures of a board yet: choose some.")
    parameters = {
        "desk": desk.slug,
        "camera": camera,
        "board": board.as_json(),
        "model": model.as_json(),
        "sent": sent,
    }
    return queue.create_once(Job.Kind.SOLVE_LENS, desk.dataset, parameters, user)


def jobs_of(desk: Desk, camera: str) -> Any:
    """The newest first."""
    found = Job.objects.filter(kind=Job.Kind.SOLVE_LENS, parameters__desk=desk.slug)
    return found.filter(parameters__camera=camera).order_by("-created_at", "-pk")


def run(mine: queue.Run) -> dict[str, Any]:
    parameters, progress = mine.job.parameters, percents(mine, SHARES)
    desk = Desk.objects.filter(slug=parameters["desk"]).first()
    row = desk.cameras.filter(name=parameters["camera"]).first() if desk else None
    if desk is None or row is None:
        raise queue.JobError("The desk or the camera is no longer there.")
    board, model = Board(**parameters["board"]), LensModel(**parameters["model"])
    result: dict[str, Any] = {"unreadable": [], "notes": []}
    sent = settings.UPLOADS_ROOT / parameters["sent"] if parameters["sent"] else None
    if sent is not None and sent.is_dir():
        with pictures_in_use():
            result |= _keep_all(row, sent, progress)
    row.board = {"board": board.as_json(), "model": model.as_json()}
    row.save(update_fields=["board"])
    result["other"] = _look(row, board, progress)
    result |= _solve(desk, row, model, progress, mine.job.created_by)
    if sent is not None:
        shutil.rmtree(sent, ignore_errors=True)
    return result


def _keep_all(row: DeskCamera, sent: Path, progress: Progress) -> dict[str, Any]:
    """Raises JobError for what no pictures can be taken from."""
    entries = sorted(sent.iterdir())
    path = entries[0] if len(entries) == 1 and not _is_picture(entries[0]) else sent
    try:
        source = open_source(path)
        _refuse_other_size(row, source.size)
        unreadable = []
        for number, picture in enumerate(source.read(), start=1):
            if isinstance(picture, NotFound):
                unreadable.append({"name": picture.name, "reason": picture.reason})
            else:
                _keep(row, picture, _bytes_of(path, picture.name))
            progress(KEEPING, min(number, source.count), source.count)
    except SourceError as error:
        raise queue.JobError(str(error).replace(f"{settings.UPLOADS_ROOT}/", "")) from error
    return {"unreadable": unreadable, "notes": list(source.notes)}


def _is_picture(path: Path) -> bool:
    return path.suffix.lower() in {".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff", ".webp", ".pgm", ".ppm"}


def _refuse_other_size(row: DeskCamera, size: tuple[int, int]) -> None:
    there = row.board_pictures.first()
    try:
        refuse_size(row, size)
    except DeskError as error:
        raise queue.JobError(str(error)) from error
    if there is not None and (there.width, there.height) != size:
        raise queue.JobError(
            f"The pictures have {size[0]}×{size[1]} pixels, those sent before {there.width}×{there.height}. "
            "Remove the old ones first: one lens is solved from one size."
        )


def _bytes_of(path: Path, name: str) -> bytes | None:
    """The picture's own file; None for a frame of a video."""
    if path.is_dir():
        return (path / name).read_bytes()
    if zipfile.is_zipfile(path):
        with zipfile.ZipFile(path) as archive:
            return archive.read(name)
    return None


def _keep(row: DeskCamera, picture: Picture, data: bytes | None) -> None:
    """A picture that is there with the same bytes keeps what was found in it."""
    data = data or _png(picture)
    digest = digest_of(data)
    name = picture.name[-200:]
    if row.board_pictures.filter(name=name, source_digest=digest).exists():
        return
    try:
        made = make_derivatives(data)
    except ImageError:
        made = make_derivatives(_png(picture))  # a kind of file that browsers do not show
    width, height = picture.size
    values = {
        "source_digest": digest,
        "light_digest": made.light_digest,
        "full_digest": made.full_digest,
        "width": width,
        "height": height,
        "searched": "",
        "found": None,
        "reason": "",
        "used": True,
    }
    BoardPicture.objects.update_or_create(camera=row, name=name, defaults=values)


def _png(picture: Picture) -> bytes:
    written, data = cv2.imencode(".png", picture.grey)
    if not written:
        raise OSError(f"{picture.name}: the picture could not be encoded")
    return data.tobytes()


def _look(row: DeskCamera, board: Board, progress: Progress) -> str:
    """Write down what is found in every picture; columns × rows that fit more of them than the board."""
    digest = boards.digest_of(board)
    waiting = list(row.board_pictures.exclude(searched=digest).order_by("name"))
    others: Counter[str] = Counter()
    missing = 0
    for number, kept in enumerate(waiting, start=1):
        found = _found(kept, board, explain=missing < EXPLAINED)
        kept.searched = digest
        if isinstance(found, BoardView):
            kept.found, kept.reason = boards.found_in(found), ""
        else:
            missing += 1
            kept.found, kept.reason = None, found.reason
            if found.other:
                others[f"{found.other[0]} × {found.other[1]}"] += 1
        kept.save(update_fields=["searched", "found", "reason"])
        progress(LOOKING, number, len(waiting))
    found_count = row.board_pictures.filter(found__isnull=False).count()
    size, count = others.most_common(1)[0] if others else ("", 0)
    return size if count > found_count else ""


def _found(kept: BoardPicture, board: Board, *, explain: bool) -> BoardView | NotFound:
    with default_storage.open(storage_name(kept.full_digest)) as stream:
        picture = decoded(kept.name, stream.read())
    return picture if isinstance(picture, NotFound) else find_board(picture, board, explain)


def _solve(
    desk: Desk, row: DeskCamera, model: LensModel, progress: Progress, user: User | None
) -> dict[str, Any]:
    """Choose among what was found and solve. Too few views are no failure: the page says what is missing."""
    every = row.board_pictures.order_by("name")
    found = [each for each in every if each.found is not None]
    counts = {"pictures": len(every), "found": len(found)}
    progress(SOLVING, 0, 1)
    try:
        switches, views = boards.chosen(row, found)
        size = (every[0].width, every[0].height) if every else (0, 0)
        names = {view.name for view in views}
        digests = [each.source_digest for each in found if each.name in names]
        value = boards.lens_value(boards.solved(views, size, model), digests)
    except DeskError as error:
        return {**counts, "problem": str(error)}
    page = edits.lens_page(row.name)
    edits.edit(desk, page, "lens solved", [*switches, (LENS, [row.name], value)], user)
    return {**counts, "problem": "", "verdict": value["report"]["verdict"], "words": value["report"]["words"]}
