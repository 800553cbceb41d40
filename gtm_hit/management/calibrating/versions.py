"""Versions of a dataset's calibration in words, for a terminal."""

from __future__ import annotations

from collections.abc import Iterator

from gtm_hit.calibration.comparing import CameraChange
from gtm_hit.models import Calibration
from gtm_hit.ops.calibration.differences import Difference
from gtm_hit.ops.calibration.reports import Section
from gtm_hit.ops.calibration.usage import placings, usage

NUMBERS = ("centre cm", "turned °", "fx px", "fy px", "cx px", "cy px", "lens px")
SHIFTS = ("cells", "median cm", "95 % cm", "most cm", "lost")
BOXES = ("boxes", "moved", "median px", "95 % px", "most px", "appear", "vanish")


def shown(version: Calibration, in_place: bool) -> Iterator[str]:
    """Where a version is from, each time that it was put in place, and what was made under it."""
    yield f"calibration {version.number}{', in place' if in_place else ''}  {version.digest}"
    made = usage(version)
    releases = ", ".join(str(number) for number in made.releases) or "none"
    yield f"{made.saves} saves of {made.layers} layers; releases: {releases}"
    for each in placings(version):
        yield f"{each.at:%Y-%m-%d %H:%M} UTC  {each.source or '–'}{f'  by {each.by}' if each.by else ''}"
        for section in each.sections:
            yield from _section(section)


def differing(found: Difference) -> Iterator[str]:
    """Cameras, ground, boxes: a table each."""
    yield f"from {found.before.words} to {found.after.words}"
    names = [change.name for change in found.change.cameras]
    yield from _table(NUMBERS, names, [_numbers(change) for change in found.change.cameras])
    yield ""
    yield f"where a pixel lies on the ground, in cells of {100 * found.change.cells.side:g} cm"
    yield from _table(SHIFTS, names, [_shifts(change) for change in found.change.cameras])
    for band in found.worst_bands():
        yield f"  {band.words:16}{band.percent:6.1f} % of the cells, the worst camera of each"
    yield ""
    yield f"boxes of {found.compared} of {found.annotations} annotations"
    yield from _table(BOXES, names, [_boxes(each) for each in found.boxes])


def _numbers(change: CameraChange) -> list[str]:
    step = change.after.matrix - change.before.matrix
    lens = "–" if change.distortion is None else f"{change.distortion:.2f}"
    moved = [f"{value:+.2f}" for value in (step[0, 0], step[1, 1], step[0, 2], step[1, 2])]
    return [f"{change.moved:.2f}", f"{change.turned:.4f}", *moved, lens]


def _shifts(change: CameraChange) -> list[str]:
    ground = change.ground
    told = ["–" if value is None else f"{value:.2f}" for value in (ground.median, ground.p95, ground.most)]
    return [str(ground.seen), *told, str(ground.lost)]


def _boxes(each: dict[str, float]) -> list[str]:
    names = ("compared", "moved", "median", "p95", "max", "appeared", "vanished")
    return [f"{each[name]:.0f}" for name in names]


def _table(heading: tuple[str, ...], names: list[str], rows: list[list[str]]) -> Iterator[str]:
    yield f"{'camera':10}" + "".join(f"{each:>11}" for each in heading)
    for name, row in zip(names, rows, strict=True):
        yield f"{name:10}" + "".join(f"{each:>11}" for each in row)


def _section(section: Section) -> Iterator[str]:
    yield f"  {section.title}"
    for fact in section.facts:
        yield f"    {fact.name}: {fact.value}"
    lines = [section.heading, *section.rows] if section.rows else []
    widths = [max(len(line[column]) for line in lines) for column in range(len(section.heading))]
    for line in lines:
        yield "    " + "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
    for note in section.notes:
        yield f"    {note}"
