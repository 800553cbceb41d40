"""Clicks to adjust with out of files, and a desk as a `ba_problem.txt`.

A file's clicks are kept as a row, whose use is one edit; what it measured goes to the page Ground.
"""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import PurePosixPath
from typing import Any

import numpy as np
from django.contrib.auth.models import User
from django.db import transaction

from gtm_hit.calibration.adjustment.correspondences import PARTS, correspondences
from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.parameters import packed
from gtm_hit.calibration.adjustment.problem import View, file_of
from gtm_hit.calibration.adjustment.settling import settled
from gtm_hit.calibration.adjustment.system import all_points, observations
from gtm_hit.calibration.lens_numbers import lens_of
from gtm_hit.formats.calibration.ba_problem import BaProblem, ba_problem_text, parse_ba_problem
from gtm_hit.formats.calibration.pos_file import Numbering, PosFile, parse_pos
from gtm_hit.models import Click, ClickFile, Desk
from gtm_hit.ops.desk import adjust_clicks, adjust_inputs, edits, poses
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.desk.adjust_results import PAGE
from gtm_hit.ops.desk.errors import DeskError, NotThere
from gtm_hit.ops.desk.things import CLICK, CLICK_FILE, POINT

MOST_FILES = 20_000
MOST_BYTES = 200_000_000
SAME_PLACE = 1e-6  # metres
Places = dict[str, list[float]]  # pixels by camera


def put_pos(
    desk: Desk,
    files: Mapping[tuple[str, str], bytes],
    name: str,
    numbering: Numbering | None = None,
    user: User | None = None,
) -> int:
    """Feet and heads of `.pos` files, by camera and frame; how many points two views see.

    Raises FormatError, DeskError, and then nothing is taken.
    """
    cameras = list(desk.cameras.order_by("index").values_list("name", flat=True))
    if unknown := sorted({camera for camera, _ in files} - set(cameras)):
        raise DeskError(f"The desk has no camera {unknown[0]}; there are: {', '.join(cameras)}.")
    read: dict[tuple[str, str], PosFile] = {
        (camera, frame): parse_pos(data, f"{camera}/{frame}.pos", numbering)
        for (camera, frame), data in files.items()
    }
    if len({file.numbering for file in read.values() if file.people}) > 1:
        raise DeskError("Some of the files number feet 0, others 1: say which it is.")
    found = correspondences(cameras, read)
    clicks: list[Places] = [{} for _ in found.names]
    seen = found.seen
    for camera, point, pixel in zip(
        seen.cameras.tolist(), seen.points.tolist(), seen.pixels.tolist(), strict=True
    ):
        clicks[point][cameras[camera]] = pixel
    points = [
        _point(f"{frame} {person} {part}", places, frame, part)
        for (frame, person, part), places in zip(found.names, clicks, strict=True)
    ]
    return _take(desk, points, name, [], user)


def files_of_zip(data: bytes) -> dict[tuple[str, str], bytes]:
    """`CAMERA/FRAME.pos`, at any depth, by camera and frame. Raises DeskError."""
    found: dict[tuple[str, str], bytes] = {}
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            entries = [each for each in archive.infolist() if each.filename.lower().endswith(".pos")]
            if len(entries) > MOST_FILES or sum(each.file_size for each in entries) > MOST_BYTES:
                raise DeskError("That is more than the clicks of one dataset can be.")
            for each in entries:
                path = PurePosixPath(each.filename)
                if len(path.parts) < 2:
                    raise DeskError(f"{each.filename}: the folder must be called as its camera is.")
                found[path.parent.name, path.stem] = archive.read(each)
    except zipfile.BadZipFile as error:
        raise DeskError("The file is no zip archive.") from error
    if not found:
        raise DeskError("There is no .pos file in it; it wants CAMERA/FRAME.pos.")
    return found


def put_any(
    desk: Desk,
    data: bytes,
    name: str,
    unit: str = "cm",
    numbering: Numbering | None = None,
    user: User | None = None,
) -> int:
    """A zip of `CAMERA/FRAME.pos` or a `ba_problem.txt`; how many points. Raises FormatError, DeskError."""
    if data[:2] == b"PK":
        return put_pos(desk, files_of_zip(data), name, numbering, user)
    return put_problem(desk, data, name, unit, user)


def put_problem(desk: Desk, data: bytes, name: str, unit: str = "cm", user: User | None = None) -> int:
    """All clicks of a `ba_problem.txt`, whose cameras are the desk's in their order; how many free points.

    Measured points and their clicks go to Ground. Lenses and poses of the file are not taken: those of the
    desk are. Raises FormatError, DeskError, and then nothing is taken.
    """
    cameras = list(desk.cameras.order_by("index"))
    file = parse_ba_problem(data, name, unit)
    if len(file.cameras) != len(cameras):
        raise DeskError(f"The file has {len(file.cameras)} cameras, the desk {len(cameras)}.")
    if unsized := [row.name for row in cameras if not row.width]:
        raise DeskError(f"No picture and no lens yet: {', '.join(unsized)}. The file does not tell the size.")
    clicks: list[Places] = [{} for _ in file.points]
    seen = file.seen
    for camera, point, pixel in zip(
        seen.cameras.tolist(), seen.points.tolist(), seen.pixels.tolist(), strict=True
    ):
        clicks[point][cameras[camera].name] = pixel
    stem = name.rpartition(".")[0] or name
    points = [_point(f"{stem} {number}", places) for number, places in enumerate(clicks)]
    return _take(desk, points, name, _measured(desk, file, [row.name for row in cameras]), user)


def stop_using(desk: Desk, digest: str, user: User | None = None) -> None:
    """Adjust without a file's clicks; they stay, so this can be undone. Raises NotThere."""
    found = desk.click_files.filter(digest=digest, used=True).first()
    if found is None:
        raise NotThere("The desk does not adjust with such a file.")
    edits.edit(desk, PAGE, f"clicks of {found.name} left out", [(CLICK_FILE, [digest], False)], user)


def problem_text(desk: Desk, choices: Choices, unit: str = "cm") -> str:
    """The desk's clicks and cameras as a `ba_problem.txt`, its points where the cameras see them.

    Raises DeskError.
    """
    problem = adjust_inputs.gather(desk, choices).problem
    views = []
    for row, view in zip(desk.cameras.order_by("index"), problem.views, strict=True):
        camera = poses.calibrated(row)
        assert camera is not None
        views.append(View(view.name, lens_of(camera), camera.rvec, camera.tvec))
    seen = observations(problem, choices.settings)
    free = np.arange(len(problem.points) + len(problem.measured)) < len(problem.points)
    points = settled(packed(views), all_points(problem), seen, free, choices.turn)[: len(problem.points)]
    try:
        return ba_problem_text(file_of(replace(problem, points=points), tuple(views), points), unit)
    except (ValueError, AdjustmentError) as error:
        raise DeskError(f"{error}.") from error


def pos_zip(desk: Desk) -> bytes:
    """Feet and heads that files brought, less what was dropped, as `CAMERA/FRAME.pos`. Raises DeskError."""
    people: dict[tuple[str, str], dict[str, list[str]]] = {}
    for click in adjust_clicks.used(desk):
        if click.part:
            person = click.point.removeprefix(f"{click.frame} ").removesuffix(f" {click.part}")
            line = f"{PARTS.index(click.part)} {click.x!r} {click.y!r}"
            people.setdefault((click.camera, click.frame), {}).setdefault(person, []).append(line)
    if not people:
        raise DeskError("No file brought feet or heads to the desk.")
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for (camera, frame), persons in sorted(people.items()):
            text = "".join("\n".join([name, *lines]) + "\n\n" for name, lines in persons.items())
            archive.writestr(zipfile.ZipInfo(f"{camera}/{frame}.pos", (1980, 1, 1, 0, 0, 0)), text)
    return stream.getvalue()


def _point(name: str, places: Places, frame: str = "", part: str = "") -> dict[str, Any]:
    assert part in {"", *PARTS}
    return {"name": name[:200], "frame": frame, "part": part, "clicks": places}


def _take(
    desk: Desk, points: Sequence[dict[str, Any]], name: str, more: list[edits.Wanted], user: User | None
) -> int:
    shared = [point for point in points if len(point["clicks"]) > 1]
    if not shared:
        raise DeskError(f"{name}: no point in it is seen by two cameras.")
    _refuse_outside(desk, shared)
    digest = hashlib.sha256(json.dumps(shared).encode()).hexdigest()
    with transaction.atomic():
        values = {"name": name[:200], "points": shared}
        ClickFile.objects.get_or_create(desk=desk, digest=digest, defaults=values)
        wanted = [*more, (CLICK_FILE, [digest], True)]
        edits.edit(desk, PAGE, f"clicks of {name}", wanted, user)
    return len(shared)


def _refuse_outside(desk: Desk, points: Sequence[dict[str, Any]]) -> None:
    """Clicks may lie a little outside: feet that the picture's edge cuts off were guessed there."""
    sizes = {row.name: (row.width, row.height) for row in desk.cameras.all()}
    for point in points:
        for camera, (x, y) in point["clicks"].items():
            width, height = sizes[camera]
            if width and not (-width < x < 2 * width and -height < y < 2 * height):
                raise DeskError(
                    f"{point['name']} is at {x:.0f}, {y:.0f} in {camera}, far outside its picture of "
                    f"{width}×{height}."
                )


def _measured(desk: Desk, file: BaProblem, cameras: list[str]) -> list[edits.Wanted]:
    """Measured points that the desk lacks, and their clicks where it has none."""
    there = list(desk.points.order_by("number"))
    number = there[-1].number if there else 0
    taken = {row.name for row in there}
    names, wanted = [], list[edits.Wanted]()
    for place in file.fixed_points.tolist():
        same = [row.name for row in there if np.allclose((row.x, row.y, row.z), place, atol=SAME_PLACE)]
        if not same:
            number += 1
            name = next(f"M{each}" for each in range(number, number + 100_000) if f"M{each}" not in taken)
            taken.add(name)
            wanted.append((POINT, [name], [number, *place]))
            same = [name]
        names.append(same[0])
    seen = file.fixed_seen
    rows = Click.objects.filter(camera__desk=desk).select_related("camera", "point")
    clicked = {(row.camera.name, row.point.name) for row in rows}
    for camera, point, pixel in zip(
        seen.cameras.tolist(), seen.points.tolist(), seen.pixels.tolist(), strict=True
    ):
        if (cameras[camera], names[point]) not in clicked:
            wanted.append((CLICK, [cameras[camera], names[point]], pixel))
    return wanted
