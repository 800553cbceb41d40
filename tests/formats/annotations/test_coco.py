from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pycocotools.coco import COCO

from gtm_hit.formats.annotations.coco import (
    CocoBox,
    CocoFile,
    CocoImage,
    CocoWriter,
    read_coco,
)
from gtm_hit.formats.problems import FormatError

IMAGE = CocoImage(1, "C1/00000005.png", 1920, 1080, frame=5, camera=0)
BOX = CocoBox(7, 1, (1510, 139, 1561, 299), person=3, position=456826)


def content() -> dict[str, Any]:
    return {
        "images": [{"id": 1, "file_name": "a.png", "width": 1920, "height": 1080}],
        "annotations": [{"id": 7, "image_id": 1, "category_id": 1, "bbox": [1510, 139, 51, 160]}],
        "categories": [{"id": 1, "name": "Person"}, {"id": 2, "name": "car"}],
    }


def read(data: bytes) -> CocoFile:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "a.json"
        path.write_bytes(data)
        try:
            return read_coco(path)
        except FormatError as error:
            raise error.relative_to(Path(folder)) from error


def parse(value: Any) -> CocoFile:
    return read(json.dumps(value).encode())


def written(images: Iterable[CocoImage], boxes: Iterable[CocoBox]) -> bytes:
    stream = io.BytesIO()
    writer = CocoWriter(stream)
    writer.boxes(boxes)
    writer.finish(images)
    return stream.getvalue()


def problems_of(change: Callable[[dict[str, Any]], object]) -> list[str]:
    changed = content()
    change(changed)
    with pytest.raises(FormatError) as caught:
        parse(changed)
    return [str(problem) for problem in caught.value.problems]


# Reading


def test_boxes_are_read_as_corners() -> None:
    coco = parse(content())
    assert coco.images == (CocoImage(1, "a.png", 1920, 1080),)
    assert coco.boxes == (CocoBox(7, 1, (1510, 139, 1561, 299)),)


def test_boxes_of_other_categories_are_left_out() -> None:
    value = content()
    value["annotations"][0]["category_id"] = 2
    assert parse(value).boxes == ()


@pytest.mark.parametrize(
    ("categories", "there"),
    [
        ([], "none"),
        ([{"id": 1, "name": "worker"}], "worker"),
        ([{"id": 1, "name": "persons"}, {"id": 2, "name": "行人"}], "persons, 行人"),
    ],
)
def test_without_a_category_of_people_the_categories_are_named(categories: list[Any], there: str) -> None:
    reason = f"no category is one of person, pedestrian, people, human; there are: {there}"
    assert problems_of(lambda one: one.update(categories=categories)) == [f"a.json: {reason}"]


@pytest.mark.parametrize("name", [" Person ", "PEDESTRIAN", "human"])
def test_people_are_found_whatever_the_case_and_spaces_of_their_category(name: str) -> None:
    assert len(parse({**content(), "categories": [{"id": 1, "name": name}]}).boxes) == 1


def test_ids_of_categories_may_be_texts() -> None:
    assert len(parse({**content(), "categories": [{"id": "1", "name": "person"}]}).boxes) == 1


def test_a_box_of_a_category_that_is_not_there_is_told() -> None:
    told = problems_of(lambda one: one["annotations"][0].update(category_id=3))
    assert told == ["a.json: annotations[0]: category_id 3 is no category of this file"]


def test_without_boxes_no_category_is_asked_for() -> None:
    assert parse({**content(), "annotations": [], "categories": []}).boxes == ()


def test_without_categories_every_box_is_a_person() -> None:
    value = content()
    del value["categories"]
    assert len(parse(value).boxes) == 1


@pytest.mark.parametrize("key", ["person_id", "track_id"])
def test_identities_go_by_two_names(key: str) -> None:
    value = content()
    value["annotations"][0][key] = 4
    assert parse(value).boxes[0].person == 4


@pytest.mark.parametrize("data", [b"{", b"[]", b"3", b'{"images": 3}', b'{"images": [NaN]}', b"[" * 99999])
def test_what_is_not_coco_is_refused(data: bytes) -> None:
    with pytest.raises(FormatError, match=r"not JSON that can be read|has no list of images"):
        read(data)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda one: one["images"][0].pop("id"), "images[0]: id is None"),
        (lambda one: one["images"][0].update(file_name=3), "images[0]: file_name is 3"),
        (lambda one: one["images"][0].update(width=True), "images[0]: width is True"),
        (lambda one: one["images"].append(5), "images[1]: is 5 instead of an object"),
        (lambda one: one["images"].append(one["images"][0]), "images: 1 is there twice"),
        (lambda one: one["annotations"][0].update(id=-1), "annotations[0]: id is -1"),
        (
            lambda one: one["annotations"][0].update(image_id=9),
            "annotation 7: image_id 9 is no image of this file",
        ),
        (
            lambda one: one["annotations"][0].update(bbox=[1, 2, 3]),
            "annotations[0]: bbox is [1, 2, 3] instead of",
        ),
        (
            lambda one: one["annotations"][0].update(bbox=[1, 2, 0, 4]),
            "annotations[0]: bbox [1, 2, 0, 4] has no area",
        ),
        (lambda one: one["annotations"][0].update(bbox=[1, 2, 1e300, 4]), "annotations[0]: bbox is"),
        (lambda one: one["annotations"][0].update(person_id="3"), "annotations[0]: person_id is '3'"),
        (lambda one: one["annotations"][0].update(score="high"), "annotations[0]: score is 'high'"),
        (lambda one: one["annotations"].append(one["annotations"][0]), "annotations: 7 is there twice"),
    ],
)
def test_a_wrong_entry_is_told_with_its_place(
    change: Callable[[dict[str, Any]], object], reason: str
) -> None:
    assert problems_of(change)[0].startswith(f"a.json: {reason}")


# Writing


def test_what_is_written_is_plain_coco() -> None:
    assert json.loads(written([IMAGE], [BOX])) == {
        "images": [
            {"id": 1, "file_name": "C1/00000005.png", "width": 1920, "height": 1080, "frame": 5, "camera": 0}
        ],
        "annotations": [
            {
                "id": 7,
                "image_id": 1,
                "category_id": 1,
                "bbox": [1510, 139, 51, 160],
                "area": 8160,
                "iscrowd": 0,
                "person_id": 3,
                "position_id": 456826,
            }
        ],
        "categories": [{"id": 1, "name": "person", "supercategory": "person"}],
    }


def test_a_file_of_nothing_comes_back() -> None:
    assert read(written([], [])) == CocoFile((), ())


def test_pycocotools_reads_what_was_written(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_bytes(written([IMAGE], [BOX]))
    theirs = COCO(str(tmp_path / "a.json"))
    assert theirs.getAnnIds(imgIds=[1], catIds=theirs.getCatIds(["person"])) == [7]
    assert theirs.loadAnns([7])[0]["bbox"] == [1510, 139, 51, 160]


ids = st.integers(0, 2**31 - 1)
optional = st.none() | ids
corners = st.integers(-(10**5), 10**5)
sizes = st.integers(1, 10**4)


@st.composite
def files(draw: st.DrawFn) -> CocoFile:
    images = [
        CocoImage(
            each, draw(st.text(min_size=1, max_size=5)), draw(ids), draw(ids), draw(optional), draw(optional)
        )
        for each in draw(st.lists(ids, unique=True, min_size=1, max_size=3))
    ]
    boxes = []
    for index, each in enumerate(draw(st.lists(ids, unique=True, max_size=4))):
        xmin, ymin = draw(corners), draw(corners)
        box = (xmin, ymin, xmin + draw(sizes), ymin + draw(sizes))
        score = draw(st.none() | st.sampled_from([0.5, 1.0]))
        boxes.append(CocoBox(each, draw(st.sampled_from(images)).id, box, index, draw(optional), score))
    return CocoFile(tuple(images), tuple(boxes))


@given(files())
def test_what_was_written_comes_back(one: CocoFile) -> None:
    assert read(written(one.images, one.boxes)) == one


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)
entries = st.dictionaries(
    st.sampled_from(["id", "image_id", "file_name", "width", "bbox", "category_id", "person_id", "score"]),
    json_values,
)


@settings(max_examples=60)
@given(st.lists(entries | json_values, max_size=3), json_values | st.lists(entries, max_size=2))
def test_any_values_are_either_read_or_refused(annotations: list[Any], images: Any) -> None:
    nearly = content()
    nearly["annotations"] += annotations
    nearly["categories"] += annotations
    for value in (
        nearly,
        {**nearly, "images": images},
        annotations,
        {"images": images, "annotations": annotations},
    ):
        try:
            parse(value)
        except FormatError as error:
            assert error.problems


@given(st.binary(max_size=100))
def test_any_bytes_are_either_read_or_refused(data: bytes) -> None:
    with pytest.raises(FormatError):
        read(data)
