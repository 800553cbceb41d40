"""What an import is told: where the files are, and what the files do not say."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypedDict

from django.core.exceptions import ValidationError

from gtm_hit.formats.problems import ProblemList, shown
from gtm_hit.geometry.cylinder import CylinderError, FootRule
from gtm_hit.geometry.grid import GridError
from gtm_hit.models import Dataset, Layer


class SceneValues(TypedDict, total=False):
    """Fields of Dataset that no file states; the dataset, the preset or a default give what is left out."""

    columns: int
    rows: int
    step: float
    origin_x: float
    origin_y: float
    cylinder_radius: float
    cylinder_height: float
    foot_rule: str
    frame_rate: float
    frame_step: int
    annotation_offset: int
    annotation_digits: int


@dataclass(frozen=True)
class Preset:
    tvec_unit: str
    values: SceneValues


PRESETS = {
    "wildtrack": Preset(
        "cm",
        SceneValues(
            columns=480,
            rows=1440,
            step=0.025,
            origin_x=-3.0,
            origin_y=-9.0,
            cylinder_radius=0.16,
            cylinder_height=1.8,
            foot_rule=FootRule.CORNERS.value,
            frame_rate=10.0,
            frame_step=5,
            annotation_offset=0,
            annotation_digits=8,
        ),
    ),
    "multiviewx": Preset(
        "m",
        SceneValues(
            columns=1000,
            rows=640,
            step=0.025,
            origin_x=0.0,
            origin_y=0.0,
            cylinder_radius=0.16,
            cylinder_height=1.8,
            foot_rule=FootRule.CENTRE.value,
            frame_rate=2.0,
            frame_step=1,
            annotation_offset=1,
            annotation_digits=5,
        ),
    ),
}

DEFAULTS = SceneValues(
    cylinder_radius=0.16,
    cylinder_height=1.8,
    foot_rule=FootRule.CORNERS.value,
    frame_step=1,
)

# 110 m × 110 m at 2.5 cm; the table of one camera has 160 MB then. More is a slip of the fingers.
MOST_POSITIONS = 20_000_000
MOST_RECTANGLES = 160_000_000  # positions × cameras; the whole table has 1.3 GB then
DIGITS = range(1, 10)

# A wrong guess here would shift every position or change every speed without anybody noticing.
REQUIRED = {
    "columns": "--grid COLUMNSxROWS",
    "step": "--step METRES",
    "origin_x": "--origin X,Y",
    "frame_rate": "--frame-rate NUMBERS_PER_SECOND",
}


@dataclass(frozen=True)
class ImportOptions:
    """`values` holds only what was given explicitly; folders are absolute, or seen from `folder`."""

    slug: str
    folder: Path
    name: str = ""
    preset: str | None = None
    values: SceneValues = field(default_factory=lambda: SceneValues())
    tvec_unit: str | None = None
    images: Path | None = None
    calibrations: Path | None = None
    annotations: Path | None = None
    undistort: bool = False
    alpha: float | None = None  # with `undistort`: how much is kept; None: the files' camera matrix
    layer: str = "imported"
    layer_kind: str = Layer.Kind.IMPORTED.value
    hidden_layer: bool = False
    keep_all_frames: bool = False

    @property
    def unit(self) -> str:
        if self.tvec_unit:
            return self.tvec_unit
        return PRESETS[self.preset].tvec_unit if self.preset else "m"


def scene(options: ImportOptions, existing: Dataset | None, problems: ProblemList) -> Dataset:
    """An unsaved dataset with every value: given explicitly, else the existing one's, else preset or default.

    What was given explicitly and contradicts the existing dataset is a problem, as is what nobody knows.
    """
    values: dict[str, object] = {**DEFAULTS}
    if options.preset:
        values.update(PRESETS[options.preset].values)
    if existing is not None:
        values.update({name: getattr(existing, name) for name in SceneValues.__annotations__})
        _tell_contradictions(options, existing, problems)
    values.update(options.values)
    if options.alpha is not None and not (options.undistort and 0 <= options.alpha <= 1):
        problems.add("options", "alpha is from 0 to 1, and only where the lens is taken out")
    missing = [option for name, option in REQUIRED.items() if name not in values]
    if missing:
        problems.add("options", f"not known: {', '.join(missing)}; or choose a --preset")
    dataset = Dataset(
        slug=options.slug, name=options.name or options.slug, undistorted=options.undistort, **values
    )
    _tell_impossible(dataset, problems)
    return dataset


def tell_too_many(dataset: Dataset, cameras: int, problems: ProblemList) -> None:
    """A table that no disk and no browser wants."""
    count = dataset.columns * dataset.rows
    if count * cameras > MOST_RECTANGLES:
        problems.add(
            "options",
            f"--grid has {count:,} positions, which {cameras} cameras make {count * cameras:,} rectangles; "
            f"at most {MOST_RECTANGLES:,} are sensible: {MOST_RECTANGLES // cameras:,} positions",
        )


def _tell_impossible(dataset: Dataset, problems: ProblemList) -> None:
    try:
        dataset.full_clean(validate_unique=False)
    except ValidationError as error:
        for name, messages in error.message_dict.items():
            problems.add("options", f"{name}: {' '.join(messages)}")
        return
    try:
        positions, _cylinder = dataset.grid.count, dataset.cylinder
    except (GridError, CylinderError) as error:
        problems.add("options", str(error))
        return
    if positions > MOST_POSITIONS:
        reason = f"--grid has {positions:,} positions; at most {MOST_POSITIONS:,} are sensible"
        problems.add("options", reason)
    if not math.isfinite(dataset.frame_rate):
        problems.add("options", f"frame_rate must be finite, not {dataset.frame_rate}")
    if dataset.annotation_digits not in DIGITS:
        problems.add("options", f"annotation_digits must be {DIGITS[0]} to {DIGITS[-1]}")


def _tell_contradictions(options: ImportOptions, existing: Dataset, problems: ProblemList) -> None:
    for name, value in options.values.items():
        if value != getattr(existing, name):
            there = shown(getattr(existing, name))
            problems.add("options", f"{name} is {there} in dataset {existing.slug}, not {shown(value)}")
    if options.undistort != existing.undistorted:
        problems.add(
            "options",
            f"the images of dataset {existing.slug} were imported with --undistort: give it again"
            if existing.undistorted
            else f"the images of dataset {existing.slug} were imported without --undistort",
        )
