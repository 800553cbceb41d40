"""All formats by the names commands, forms and jobs know them by."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

from gtm_hit.ops.exports.formats.published import MultiviewxWriter, PomWriter, WildtrackWriter
from gtm_hit.ops.exports.formats.target import Target, Writer
from gtm_hit.ops.exports.formats.tracking import (
    CocoViewsWriter,
    CsvWriter,
    MotViewsWriter,
    TextWriter,
)


@dataclass(frozen=True)
class ExportFormat:
    """`readme` is what an export's README says of its files."""

    label: str
    writer: Callable[[Target], Writer]
    readme: str


FORMATS: Mapping[str, ExportFormat] = {
    "wildtrack": ExportFormat(
        "WILDTRACK: JSON per frame, calibrations",
        WildtrackWriter,
        """\
annotations_positions/   one JSON file per frame: a list of people, each with
    personID      the same person has the same number in all frames
    positionID    row * {columns} + column on the ground grid
    views         one rectangle per camera in pixels, all four -1 where the person is not visible
    x, y          the same position in metres
    height, radius  of this person in metres, where they are not the usual ones
    origin        how the position came about
    validated     false where nobody confirmed a position that was carried over
  The number in a file name is the frame number plus {offset}.
calibrations/   OpenCV XML per camera; tvec in {unit}
""",
    ),
    "multiviewx": ExportFormat(
        "MultiviewX layout with its table of rectangles",
        MultiviewxWriter,
        """\
multiviewx/   the same JSON, calibrations (tvec in metres) and rectangles.pom as MultiviewX names them
""",
    ),
    "pom": ExportFormat(
        "Rectangles of all positions (POM)",
        PomWriter,
        """\
rectangles.pom   the rectangle of every position in every camera
""",
    ),
    "mot": ExportFormat(
        "MOTChallenge: per view and on the ground",
        MotViewsWriter,
        """\
mot/VIEW/gt/gt.txt     MOTChallenge: frame,id,left,top,width,height,1,1,1
mot/ground/gt/gt.txt   frame,id,-1,-1,-1,-1,1,x,y,z in metres
  Frames count from 1 in the order of the dataset's frames; id is the person's number plus 1.
""",
    ),
    "coco": ExportFormat(
        "COCO boxes per view",
        CocoViewsWriter,
        """\
coco/VIEW.json   COCO boxes with person_id and position_id; frame and camera at each image
""",
    ),
    "csv": ExportFormat(
        "CSV in metres",
        CsvWriter,
        """\
people.csv   frame,person,x,y,height in metres; height is empty for the usual one
""",
    ),
    "text": ExportFormat(
        "frame column row text (MVDet's evaluation)",
        TextWriter,
        """\
frame_column_row/gt.txt       frame column row of everybody some camera sees
frame_column_row/people.txt   frame column row person of everybody
""",
    ),
}
DEFAULT_FORMATS = ("wildtrack",)


def chosen(names: Collection[str]) -> list[str]:
    """Known names in the order of FORMATS; ValueError for an unknown one, or none."""
    unknown = sorted(set(names) - FORMATS.keys())
    if unknown or not names:
        raise ValueError(f"not formats: {', '.join(unknown)}" if unknown else "no format chosen")
    return [name for name in FORMATS if name in names]
