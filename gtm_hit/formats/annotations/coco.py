"""COCO boxes of one view: `images`, `annotations` with `bbox`, and one category, person.

To COCO's own keys come `frame` and `camera` of an image, `person_id` and `position_id` of a box.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

from gtm_hit.formats.annotations.coco_categories import Categories
from gtm_hit.formats.annotations.delimited_text import MOST_WHOLE
from gtm_hit.formats.annotations.json_lists import read_object
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import ProblemList, shown
from gtm_hit.formats.strict_json import json_text

MOST_BYTES = 512 * 2**20
CATEGORY = 1
_PERSON_KEYS = ("person_id", "track_id")
_FAR = 1e9  # pixels


@dataclass(frozen=True, slots=True)
class CocoImage:
    """`frame` and `camera` are None where the file does not say; then `file_name` has to tell."""

    id: int
    file_name: str
    width: int
    height: int
    frame: int | None = None
    camera: int | None = None


@dataclass(frozen=True, slots=True)
class CocoBox:
    """`box` is xmin, ymin, xmax, ymax in pixels, `image` the id of its image; ground truth has no `score`."""

    id: int
    image: int
    box: tuple[float, float, float, float]
    person: int | None = None
    position: int | None = None
    score: float | None = None


@dataclass(frozen=True)
class CocoFile:
    images: tuple[CocoImage, ...]
    boxes: tuple[CocoBox, ...]


def read_coco(path: Path) -> CocoFile:
    """Images and the boxes of people; boxes of other categories are left out.

    People twice in an image are left to the caller.

    Raises FormatError with everything wrong: keys missing or of another type, ids used twice, boxes of no
    image, of no category or without area, no category of people.
    """
    return _parsed(json_text(read_source(path, MOST_BYTES), str(path)), str(path))


def _parsed(text: str, path: str) -> CocoFile:
    problems = ProblemList(path)
    images: list[CocoImage] = []
    boxes: list[CocoBox] = []

    def take_image(index: int, entry: Any) -> None:
        if _is_object(entry, f"images[{index}]", problems):
            images.append(_image(f"images[{index}]", entry, problems))

    def take_box(index: int, entry: Any) -> None:
        place = f"annotations[{index}]"
        if _is_object(entry, place, problems) and categories.has_people(entry, place, problems):
            boxes.append(_box(place, entry, problems))

    # Twice, because most files name their categories last: only boxes of people are worth looking at.
    content = read_object(text, path, {"images": take_image, "annotations": lambda _index, _entry: None})
    for key in ("images", "annotations"):
        if not isinstance(content.get(key), list):
            problems.add("", f"has no list of {key}")
    problems.raise_if_any()
    categories = Categories.of(content.get("categories"))
    read_object(text, path, {"images": lambda _index, _entry: None, "annotations": take_box})
    _tell_wrong_ids(images, boxes, problems)
    problems.raise_if_any()
    return CocoFile(tuple(images), tuple(boxes))


def _tell_wrong_ids(images: list[CocoImage], boxes: list[CocoBox], problems: ProblemList) -> None:
    _tell_repeated("images", (image.id for image in images), problems)
    _tell_repeated("annotations", (box.id for box in boxes), problems)
    known = {image.id for image in images}
    for box in boxes:
        if box.image not in known:
            problems.add(f"annotation {box.id}", f"image_id {box.image} is no image of this file")


class CocoWriter:
    """Writes one box or image per line, as they come, so that a file of any size takes no memory."""

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream
        self._first = True
        stream.write(b'{"annotations": [')

    def boxes(self, boxes: Iterable[CocoBox]) -> None:
        self._entries(_box_entry(box) for box in boxes)

    def finish(self, images: Iterable[CocoImage]) -> None:
        category = {"id": CATEGORY, "name": "person", "supercategory": "person"}
        self._stream.write(b'],\n"images": [')
        self._first = True
        self._entries(_image_entry(image) for image in images)
        self._stream.write(b'],\n"categories": [' + json.dumps(category).encode() + b"]}\n")

    def _entries(self, entries: Iterable[Mapping[str, Any]]) -> None:
        for entry in entries:
            text = json.dumps(entry, allow_nan=False)
            self._stream.write(("\n" if self._first else ",\n").encode() + text.encode())
            self._first = False


def _image_entry(image: CocoImage) -> dict[str, Any]:
    entry = {"id": image.id, "file_name": image.file_name, "width": image.width, "height": image.height}
    return entry | _given(frame=image.frame, camera=image.camera)


def _box_entry(box: CocoBox) -> dict[str, Any]:
    xmin, ymin, xmax, ymax = box.box
    width, height = xmax - xmin, ymax - ymin
    entry = {
        "id": box.id,
        "image_id": box.image,
        "category_id": CATEGORY,
        "bbox": [xmin, ymin, width, height],
        "area": width * height,
        "iscrowd": 0,
    }
    return entry | _given(person_id=box.person, position_id=box.position, score=box.score)


def _given(**values: float | None) -> dict[str, Any]:
    return {key: value for key, value in values.items() if value is not None}


def _is_object(entry: Any, place: str, problems: ProblemList) -> bool:
    if not isinstance(entry, dict):
        problems.add(place, f"is {shown(entry)} instead of an object")
    return isinstance(entry, dict)


def _image(place: str, entry: dict[str, Any], problems: ProblemList) -> CocoImage:
    name = entry.get("file_name")
    if not isinstance(name, str) or not name:
        problems.add(place, f"file_name is {shown(name)} instead of a name")
    return CocoImage(
        _whole(entry, "id", place, problems) or 0,
        str(name),
        _whole(entry, "width", place, problems) or 0,
        _whole(entry, "height", place, problems) or 0,
        _whole(entry, "frame", place, problems, needed=False),
        _whole(entry, "camera", place, problems, needed=False),
    )


def _box(place: str, entry: dict[str, Any], problems: ProblemList) -> CocoBox:
    bbox = entry.get("bbox")
    box = (0.0, 0.0, 0.0, 0.0)
    if not (isinstance(bbox, list) and len(bbox) == 4 and all(_is_number(value) for value in bbox)):
        problems.add(place, f"bbox is {shown(bbox)} instead of four numbers")
    elif bbox[2] <= 0 or bbox[3] <= 0:
        problems.add(place, f"bbox {shown(bbox)} has no area")
    else:
        box = (bbox[0], bbox[1], bbox[0] + bbox[2], bbox[1] + bbox[3])
    score = entry.get("score")
    if score is not None and not _is_number(score):
        problems.add(place, f"score is {shown(score)} instead of a number")
    person = next((key for key in _PERSON_KEYS if entry.get(key) is not None), _PERSON_KEYS[0])
    return CocoBox(
        _whole(entry, "id", place, problems) or 0,
        _whole(entry, "image_id", place, problems) or 0,
        box,
        _whole(entry, person, place, problems, needed=False),
        _whole(entry, "position_id", place, problems, needed=False),
        score,
    )


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and abs(value) <= _FAR


def _whole(
    entry: dict[str, Any], key: str, place: str, problems: ProblemList, needed: bool = True
) -> int | None:
    value = entry.get(key)
    if value is None and not needed:
        return None
    if type(value) is int and 0 <= value <= MOST_WHOLE:
        return value
    problems.add(place, f"{key} is {shown(value)} instead of an integer from 0 to {MOST_WHOLE}")
    return None


def _tell_repeated(place: str, ids: Iterable[Any], problems: ProblemList) -> None:
    if problems:
        return  # what stands in for wrong ids would look like repetitions
    seen = set()
    for each in ids:
        if each in seen:
            problems.add(place, f"{shown(each)} is there twice")
        seen.add(each)
