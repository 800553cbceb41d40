"""What can be changed by hand at a desk, each with how it is read and written. See `edits`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from gtm_hit.models import (
    BoardPicture,
    Click,
    ClickDecision,
    Desk,
    DeskCamera,
    KeptClick,
    KeptPoint,
    MeasuredPoint,
)
from gtm_hit.ops.desk.errors import NotThere

CLICK, POINT, LENS, PICTURE, BOARD_PICTURE = "click", "point", "lens", "picture", "board picture"
KEPT_POINT, KEPT_CLICK = "kept point", "kept click"
CLICK_FILE, DECISION, ADJUSTED = "click file", "decision", "adjusted"


@dataclass(frozen=True)
class Thing:
    read: Callable[[Desk, list[str]], Any]
    write: Callable[[Desk, list[str], Any], None]


def camera_of(desk: Desk, name: str) -> DeskCamera:
    """Raises NotThere."""
    found = desk.cameras.filter(name=name).first()
    if found is None:
        raise NotThere(f"The desk has no camera {name}.")
    return found


def camera_named(kind: str, key: list[str]) -> str:
    """The camera a thing is about; empty for a point or a file, which are about none."""
    if kind in {POINT, KEPT_POINT, CLICK_FILE}:
        return ""
    return key[-1] if kind in {KEPT_CLICK, DECISION} else key[0]


def point_of(desk: Desk, name: str) -> MeasuredPoint:
    """Raises NotThere."""
    found = desk.points.filter(name=name).first()
    if found is None:
        raise NotThere(f"The desk has no point {name}.")
    return found


def read_click(desk: Desk, key: list[str]) -> list[float] | None:
    """x and y, pixels, of [camera, point]."""
    camera, point = key
    found = Click.objects.filter(camera__desk=desk, camera__name=camera, point__name=point).first()
    return [found.x, found.y] if found else None


def write_click(desk: Desk, key: list[str], value: list[float] | None) -> None:
    camera, point = camera_of(desk, key[0]), point_of(desk, key[1])
    if value is None:
        Click.objects.filter(camera=camera, point=point).delete()
        return
    x, y = value
    Click.objects.update_or_create(camera=camera, point=point, defaults={"x": x, "y": y})


def read_point(desk: Desk, key: list[str]) -> list[float] | None:
    """Number, x, y, z of [name]."""
    found = desk.points.filter(name=key[0]).first()
    return [found.number, found.x, found.y, found.z] if found else None


def write_point(desk: Desk, key: list[str], value: list[float] | None) -> None:
    if value is None:
        desk.points.filter(name=key[0]).delete()
        return
    number, x, y, z = value
    defaults = {"number": int(number), "x": x, "y": y, "z": z}
    MeasuredPoint.objects.update_or_create(desk=desk, name=key[0], defaults=defaults)


def read_lens(desk: Desk, key: list[str]) -> dict[str, Any] | None:
    """Lens, report and size of [camera]: what one solve or one file gave together."""
    camera = camera_of(desk, key[0])
    if camera.lens is None:
        return None
    size = [camera.width, camera.height]
    return {"lens": camera.lens, "report": camera.lens_report, "size": size}


def write_lens(desk: Desk, key: list[str], value: dict[str, Any] | None) -> None:
    camera = camera_of(desk, key[0])
    if value is None:
        camera.lens, camera.lens_report = None, {}
        if not camera.full_digest:
            camera.width = camera.height = 0
    else:
        camera.lens, camera.lens_report = value["lens"], value["report"]
        camera.width, camera.height = value["size"]
    camera.save(update_fields=["lens", "lens_report", "width", "height"])


def read_picture(desk: Desk, key: list[str]) -> list[Any] | None:
    """Digests light and full, width and height of the picture of the ground of [camera]."""
    camera = camera_of(desk, key[0])
    if not camera.full_digest:
        return None
    return [camera.light_digest, camera.full_digest, camera.width, camera.height]


def write_picture(desk: Desk, key: list[str], value: list[Any] | None) -> None:
    camera = camera_of(desk, key[0])
    if value is None:
        camera.light_digest = camera.full_digest = ""
        if camera.lens is None:
            camera.width = camera.height = 0
    else:
        camera.light_digest, camera.full_digest, camera.width, camera.height = value
    camera.save(update_fields=["light_digest", "full_digest", "width", "height"])


def read_board_picture(desk: Desk, key: list[str]) -> bool | None:
    """Whether the picture [camera, name] is used."""
    camera, name = key
    rows = BoardPicture.objects.filter(camera__desk=desk, camera__name=camera, name=name)
    return rows.values_list("used", flat=True).first()


def write_board_picture(desk: Desk, key: list[str], value: bool | None) -> None:
    camera, name = key
    rows = BoardPicture.objects.filter(camera__desk=desk, camera__name=camera, name=name)
    if value is None or not rows.update(used=value):
        raise NotThere(f"The camera {camera} has no picture {name}.")


def read_kept_point(desk: Desk, key: list[str]) -> str | None:
    """What [name] is used for."""
    return desk.kept_points.filter(name=key[0]).values_list("use", flat=True).first()


def write_kept_point(desk: Desk, key: list[str], value: str | None) -> None:
    """Its clicks are things of their own: take them away first, so that undoing brings them back."""
    if value is None:
        desk.kept_points.filter(name=key[0]).delete()
        return
    KeptPoint.objects.update_or_create(desk=desk, name=key[0], defaults={"use": value})


def read_kept_click(desk: Desk, key: list[str]) -> list[float] | None:
    """x and y, pixels, of [point, camera]."""
    point, camera = key
    found = KeptClick.objects.filter(point__desk=desk, point__name=point, camera__name=camera).first()
    return [found.x, found.y] if found else None


def write_kept_click(desk: Desk, key: list[str], value: list[float] | None) -> None:
    point, camera = desk.kept_points.filter(name=key[0]).first(), camera_of(desk, key[1])
    if point is None:
        raise NotThere(f"The desk has no kept point {key[0]}.")
    if value is None:
        KeptClick.objects.filter(point=point, camera=camera).delete()
        return
    x, y = value
    KeptClick.objects.update_or_create(point=point, camera=camera, defaults={"x": x, "y": y})


def read_click_file(desk: Desk, key: list[str]) -> bool | None:
    """Whether the clicks with digest [digest] are adjusted with."""
    return desk.click_files.filter(digest=key[0]).values_list("used", flat=True).first()


def write_click_file(desk: Desk, key: list[str], value: bool | None) -> None:
    if not desk.click_files.filter(digest=key[0]).update(used=bool(value)):
        raise NotThere("The desk has no such file of clicks.")


def read_decision(desk: Desk, key: list[str]) -> list[Any] | None:
    """Decision, x and y of the click [source, point, camera]."""
    source, point, camera = key
    found = desk.click_decisions.filter(source=source, point=point, camera=camera).first()
    return [found.decision, found.x, found.y] if found else None


def write_decision(desk: Desk, key: list[str], value: list[Any] | None) -> None:
    source, point, camera = key
    if value is None:
        desk.click_decisions.filter(source=source, point=point, camera=camera).delete()
        return
    decision, x, y = value
    values = {"decision": decision, "x": x, "y": y}
    ClickDecision.objects.update_or_create(
        desk=desk, source=source, point=point, camera=camera, defaults=values
    )


def read_adjusted(desk: Desk, key: list[str]) -> dict[str, Any] | None:
    """Lens and pose of the adjustment that [camera] uses, and what it began from."""
    adjusted: dict[str, Any] | None = camera_of(desk, key[0]).adjusted
    return adjusted


def write_adjusted(desk: Desk, key: list[str], value: dict[str, Any] | None) -> None:
    camera = camera_of(desk, key[0])
    camera.adjusted = value
    camera.save(update_fields=["adjusted"])


THINGS: dict[str, Thing] = {
    CLICK: Thing(read_click, write_click),
    POINT: Thing(read_point, write_point),
    LENS: Thing(read_lens, write_lens),
    PICTURE: Thing(read_picture, write_picture),
    BOARD_PICTURE: Thing(read_board_picture, write_board_picture),
    KEPT_POINT: Thing(read_kept_point, write_kept_point),
    KEPT_CLICK: Thing(read_kept_click, write_kept_click),
    CLICK_FILE: Thing(read_click_file, write_click_file),
    DECISION: Thing(read_decision, write_decision),
    ADJUSTED: Thing(read_adjusted, write_adjusted),
}
