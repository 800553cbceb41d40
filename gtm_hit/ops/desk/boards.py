"""Pictures of boards: kept, looked through as a job, and solved into a lens."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from typing import Any

import numpy as np
from django.contrib.auth.models import User
from django.db import transaction

from gtm_hit.calibration.boards import Board, BoardError, BoardKind
from gtm_hit.calibration.choosing import choose
from gtm_hit.calibration.intrinsics import LensError, LensSolution, solve_lens
from gtm_hit.calibration.lens_models import LensModel
from gtm_hit.calibration.lens_report import lens_report
from gtm_hit.calibration.verdict import judge
from gtm_hit.calibration.views import BoardView
from gtm_hit.models import BoardPicture, Desk, DeskCamera
from gtm_hit.ops.desk import edits
from gtm_hit.ops.desk.errors import DeskError, NotThere
from gtm_hit.ops.desk.lenses import refuse_size
from gtm_hit.ops.desk.things import BOARD_PICTURE, LENS, camera_of

FROM_BOARDS = "pictures of a board"


def board_of(facts: dict[str, Any]) -> Board:
    """Raises DeskError with a sentence."""
    known = {name: facts[name] for name in asdict_names() if facts.get(name) is not None}
    try:
        return Board(**{**known, "kind": BoardKind(known["kind"])})
    except (BoardError, ValueError, TypeError, KeyError) as error:
        raise DeskError(str(error)) from error


def asdict_names() -> list[str]:
    return list(Board.__dataclass_fields__)


def digest_of(board: Board) -> str:
    return hashlib.sha256(json.dumps(board.as_json(), sort_keys=True).encode()).hexdigest()


def pictures_of(desk: Desk, camera: str) -> list[BoardPicture]:
    """Raises NotThere."""
    return list(camera_of(desk, camera).board_pictures.order_by("name"))


def picture_of(desk: Desk, camera: str, name: str) -> BoardPicture:
    """Raises NotThere."""
    found = camera_of(desk, camera).board_pictures.filter(name=name).first()
    if found is None:
        raise NotThere(f"The camera {camera} has no picture {name}.")
    return found


def view_of(picture: BoardPicture) -> BoardView:
    found = picture.found
    assert found is not None
    return BoardView(
        picture.name,
        np.array(found["pixels"], dtype=np.float64),
        np.array(found["points"], dtype=np.float64),
        np.array(found["ids"], dtype=np.int64),
    )


def found_in(view: BoardView) -> dict[str, Any]:
    """As a row keeps it."""
    return {
        "pixels": view.pixels.tolist(),
        "points": view.points.tolist(),
        "ids": view.ids.tolist(),
    }


def remove_all(desk: Desk, camera: str) -> int:
    """All pictures of boards of a camera; the lens that was solved from them stays. Raises NotThere."""
    row = camera_of(desk, camera)
    with transaction.atomic():
        Desk.objects.select_for_update().get(pk=desk.pk)
        page = edits.lens_page(camera)
        desk.edits.filter(page=page).update(page=f"{page} before its pictures were removed"[:100])
        return row.board_pictures.all().delete()[0]


def switch(desk: Desk, camera: str, name: str, used: bool, user: User | None = None) -> None:
    """Let a picture take part in the solve, or not, and solve again. Raises DeskError."""
    picture = picture_of(desk, camera, name)
    if picture.found is None:
        raise DeskError(f"No board was found in {name}: {picture.reason}")
    row = picture.camera
    kept = [each for each in usable(row) if each.name != name]
    views = [view_of(each) for each in [*kept, *([picture] if used else [])]]
    what = f"{name} {'used' if used else 'left out'}"
    wanted: list[edits.Wanted] = [(BOARD_PICTURE, [camera, name], used)]
    _edit(desk, row, what, wanted, views, model_of(row), user)


def use_model(desk: Desk, camera: str, model: LensModel, user: User | None = None) -> None:
    """Solve the pictures that are used with another model. Raises DeskError."""
    row = camera_of(desk, camera)
    views = [view_of(each) for each in usable(row)]
    _edit(desk, row, f"model: {model.coefficients.value}", [], views, model, user)


def use_chosen(desk: Desk, camera: str, user: User | None = None) -> None:
    """Let the program choose among all pictures with a board, and solve. Raises DeskError."""
    row = camera_of(desk, camera)
    found = [each for each in row.board_pictures.order_by("name") if each.found is not None]
    _edit(desk, row, "views chosen", *chosen(row, found), model_of(row), user)


def chosen(row: DeskCamera, found: Iterable[BoardPicture]) -> tuple[list[edits.Wanted], list[BoardView]]:
    """What is switched on and off, and the views that are solved."""
    views = {each.name: view_of(each) for each in found}
    size = next(((each.width, each.height) for each in found), (0, 0))
    names = set(choose(list(views.values()), size))
    switches: list[edits.Wanted] = [(BOARD_PICTURE, [row.name, name], name in names) for name in views]
    return switches, [view for name, view in views.items() if name in names]


def usable(row: DeskCamera) -> list[BoardPicture]:
    """Pictures with a board that are switched on."""
    return [each for each in row.board_pictures.order_by("name") if each.used and each.found is not None]


def model_of(row: DeskCamera) -> LensModel:
    """The one asked for last."""
    return LensModel(**(row.board or {}).get("model", {}))


def solved(views: list[BoardView], size: tuple[int, int], model: LensModel) -> LensSolution:
    """Raises DeskError."""
    try:
        return solve_lens(views, size, model)
    except LensError as error:
        raise DeskError(str(error)) from error


def lens_value(solution: LensSolution, inputs: list[str]) -> dict[str, Any]:
    """The value of the thing LENS: numbers, report, size."""
    verdict = judge(solution)
    report = lens_report(solution, verdict)
    for view, told in zip(solution.views, report["views"], strict=True):
        told["residuals"] = np.round(view.residuals, 4).tolist()
    words = " ".join(dict.fromkeys([*(each.text for each in verdict.reasons[:1]), verdict.next_step]))
    lens = solution.lens
    return {
        "lens": {
            "matrix": lens.matrix.tolist(),
            "distortion": lens.distortion.tolist(),
            "source": FROM_BOARDS,
        },
        "report": {**report, "words": words, "inputs": inputs},
        "size": [lens.width, lens.height],
    }


def _edit(
    desk: Desk,
    row: DeskCamera,
    what: str,
    switches: list[edits.Wanted],
    views: list[BoardView],
    model: LensModel,
    user: User | None,
) -> None:
    """Switches and the lens that follows from them, in one step."""
    if not views:
        raise DeskError("No picture with a board would be left.")
    size = _size(row)
    refuse_size(row, size)
    names = {view.name for view in views}
    digests = row.board_pictures.filter(name__in=names).order_by("name")
    value = lens_value(solved(views, size, model), list(digests.values_list("source_digest", flat=True)))
    with transaction.atomic():
        edits.edit(desk, edits.lens_page(row.name), what, [*switches, (LENS, [row.name], value)], user)
        keep_model(row, model)


def keep_model(row: DeskCamera, model: LensModel) -> None:
    row.refresh_from_db(fields=["board"])
    row.board = {**(row.board or {}), "model": model.as_json()}
    row.save(update_fields=["board"])


def _size(row: DeskCamera) -> tuple[int, int]:
    first = row.board_pictures.first()
    if first is None:
        raise DeskError("There are no pictures of a board yet.")
    return first.width, first.height
