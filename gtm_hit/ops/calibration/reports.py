"""How a version came about, in parts that a page and a command can show: file or desk, lens, ground, adjust.

A report is a dict with optional parts: `file` (name, sha256, unit); `desk`, `step`, `points` and per camera
`lens` and `ground` in `cameras`; `adjust`, as an adjustment tells of itself. Parts that are not there are
left out, so that a report of before can be read for ever.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

SHORT = 12  # hexadecimal digits of a digest are enough to tell two apart
NONE = "–"


@dataclass(frozen=True)
class Fact:
    name: str
    value: str
    code: bool = False  # a digest: shown letter by letter


@dataclass(frozen=True)
class Section:
    title: str
    facts: Sequence[Fact] = ()
    heading: Sequence[str] = ()
    rows: Sequence[Sequence[str]] = ()
    notes: Sequence[str] = field(default=())


def sections(report: dict[str, Any]) -> list[Section]:
    """Empty for a report that has nothing to tell."""
    found = [_file(report), _desk(report), _lens(report), _ground(report), _adjust(report)]
    return [section for section in found if section is not None]


def _file(report: dict[str, Any]) -> Section | None:
    file = report.get("file")
    if not file:
        return None
    facts = [Fact("Name", file.get("name") or NONE)]
    if file.get("sha256"):
        facts.append(Fact("SHA-256", file["sha256"], code=True))
    if file.get("unit"):
        facts.append(Fact("Unit of tvec", file["unit"]))
    return Section("File", facts)


def _desk(report: dict[str, Any]) -> Section | None:
    if "desk" not in report:
        return None
    facts = [Fact("Name", report["desk"]), Fact("Steps of the hand", str(report.get("step", NONE)))]
    points = report.get("points")
    if points:
        facts.append(Fact("Measured points", str(points["count"])))
        facts.append(Fact("Their digest", points["digest"], code=True))
    return Section("Desk", facts)


def _lens(report: dict[str, Any]) -> Section | None:
    found = [(each["name"], each["lens"]) for each in report.get("cameras", []) if each.get("lens")]
    if not found:
        return None
    heading = ("Camera", "From", "Verdict", "RMS, px", "Views left out, px", "fx ±, px", "Model", "Inputs")
    return Section("Lens", heading=heading, rows=[_lens_row(name, lens) for name, lens in found])


def _lens_row(name: str, lens: dict[str, Any]) -> list[str]:
    model, inputs = lens.get("model") or {}, lens.get("inputs") or []
    words = ", ".join(
        [
            model.get("coefficients", ""),
            *(["centre fixed"] if model.get("fixed_centre") else []),
            *(["fx = fy"] if model.get("fixed_aspect") else []),
        ]
    )
    return [
        name,
        _board(lens.get("board")) if inputs else lens.get("source") or NONE,
        lens.get("verdict") or NONE,
        _number(lens.get("rms"), 3),
        _number(lens.get("holdout_rms"), 3),
        _number((lens.get("sigma") or {}).get("fx"), 2),
        words or NONE,
        f"{len(inputs)} pictures, {_together(inputs)}" if inputs else NONE,
    ]


def _board(board: dict[str, Any] | None) -> str:
    if not board:
        return NONE
    return f"{board.get('kind')} {board.get('columns')} × {board.get('rows')}, {board.get('spacing')} m"


def _together(digests: Sequence[str]) -> str:
    """The first and the last: the whole list is in the report."""
    return " … ".join(dict.fromkeys((digests[0][:SHORT], digests[-1][:SHORT])))


def _ground(report: dict[str, Any]) -> Section | None:
    found = [each for each in report.get("cameras", []) if each.get("ground")]
    if not found:
        return None
    heading = (
        "Camera",
        "Clicks",
        "Used",
        "RMS, px",
        "Centre ± along X, Y, Z, cm",
        "Picture",
        "Clicks' digest",
    )
    notes = [f"{each['name']}: {text}" for each in found for text in each["ground"].get("findings", [])]
    return Section("Ground", heading=heading, rows=[_ground_row(each) for each in found], notes=notes)


def _ground_row(camera: dict[str, Any]) -> list[str]:
    ground = camera["ground"]
    clicks, sigma = ground.get("clicks") or {}, ground.get("centre_sigma") or []
    return [
        camera["name"],
        str(clicks.get("count", NONE)),
        str(ground.get("used", NONE)),
        _number(ground.get("rms"), 2),
        ", ".join(_number(each, 1, 100) for each in sigma) or NONE,
        (camera.get("picture") or NONE)[:SHORT],
        clicks.get("digest", NONE)[:SHORT],
    ]


def _adjust(report: dict[str, Any]) -> Section | None:
    adjust = report.get("adjust")
    if not adjust:
        return None
    heading = (
        "Camera",
        "Median before, px",
        "after, px",
        "95 % after, px",
        "Went, cm",
        "Centre ±, cm",
        "Lens",
    )
    rows = [_adjusted(each) for each in adjust.get("cameras", [])]
    return Section(
        "Adjust", list(_adjust_facts(adjust)), heading if rows else (), rows, adjust.get("notices", ())
    )


def _adjust_facts(adjust: dict[str, Any]) -> Iterator[Fact]:
    if "number" in adjust:
        yield Fact("Result", str(adjust["number"]))
    yield Fact("Variant", adjust.get("variant") or NONE)
    if adjust.get("ended"):
        yield Fact("Not as adjusted", ", ".join(adjust["ended"]))
    for name, value in (adjust.get("settings") or {}).items():
        if not isinstance(value, dict | list):
            yield Fact(name.replace("_", " "), NONE if value is None else str(value))
    for name, value in (adjust.get("inputs") or {}).items():
        counted = value if isinstance(value, dict) else {"digest": str(value)}
        told = [f"{counted['count']}"] if "count" in counted else []
        yield Fact(name.replace("_", " "), ", ".join([*told, counted.get("digest", "")[:SHORT]]), code=True)
    hold_out, feet = adjust.get("hold_out") or {}, adjust.get("feet") or {}
    if "cost" in adjust:
        yield Fact("Cost", _number(adjust["cost"], 1))
    if hold_out:
        yield Fact("One view left out, median", f"{_number(hold_out.get('median_px'), 2)} px")
    if feet:
        yield Fact("Feet off the ground, median", f"{_number(feet.get('median'), 1, 100)} cm")


def _adjusted(camera: dict[str, Any]) -> list[str]:
    before, after = camera.get("before") or {}, camera.get("after") or {}
    monotone = (camera.get("folding") or {}).get("monotone")
    return [
        camera.get("name", NONE),
        _number(before.get("median"), 2),
        _number(after.get("median"), 2),
        _number(after.get("p95"), 1),
        _number(camera.get("moved"), 1, 100),
        _number(camera.get("centre_sigma"), 1, 100),
        NONE if monotone is None else "does not fold" if monotone else "folds inside the picture",
    ]


def _number(value: float | None, digits: int, times: float = 1.0) -> str:
    return NONE if value is None else f"{times * value:.{digits}f}"
