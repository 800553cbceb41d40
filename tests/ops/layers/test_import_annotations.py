"""Annotations come in whole, or nothing does and everything that does not fit is named."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import pytest
from django.core.management import CommandError, call_command

from gtm_hit.models import Annotation, Dataset, Layer, LayerFrame, Save
from gtm_hit.ops.datasets.importing import ImportFailed
from gtm_hit.ops.layers.findings import Kind
from tests.dataset_folder import boxes, cameras
from tests.ops.square_layer import content, make_square, take_in
from tests.work_scene import make_layer

pytestmark = pytest.mark.django_db

PLACE = 30 * 80 + 40  # a position all three cameras see


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"


@pytest.fixture
def dataset() -> Dataset:
    return make_square()


def refused(dataset: Dataset, path: Path, kind: str, *drop: Kind) -> list[str]:
    with pytest.raises(ImportFailed) as caught:
        take_in(dataset, path, kind, "back", *drop)
    assert not Layer.objects.exists()
    assert not LayerFrame.objects.exists()
    return [str(problem) for problem in caught.value.problems]


def text(path: Path, *lines: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(f"{line}\n" for line in lines))
    return path


def mot_line(frame: int, person: int, camera: int, position: int = PLACE) -> str:
    xmin, ymin, xmax, ymax = boxes(position)[camera]
    return f"{frame},{person},{xmin},{ymin},{xmax - xmin},{ymax - ymin},1,1,1"


def test_a_layer_has_frames_that_are_done_with_one_save_each(dataset: Dataset, tmp_path: Path) -> None:
    path = text(tmp_path / "people.csv", "frame,person,x,y,height", "5,7,0.0,0.0,1.5", "0,7,0.1,0.0,")
    report = take_in(dataset, path, "csv")
    assert (report.frames, report.people, report.annotations) == (2, 1, 2)
    head = LayerFrame.objects.get(layer=report.layer, frame__number=5)
    assert (head.revision, head.done, head.nobody) == (1, True, False)
    row = Annotation.objects.get(layer=report.layer, frame__number=5)
    assert (row.person, row.position, row.height, row.origin) == (7, PLACE, 1.5, "imported")
    assert Save.objects.get(layer_frame=head).annotations[0]["position"] == PLACE
    assert (report.layer.kind, Layer.objects.get().last_person) == (Layer.Kind.IMPORTED, 7)


def test_everything_that_does_not_fit_is_listed_at_once_with_file_and_line(
    dataset: Dataset, tmp_path: Path
) -> None:
    path = text(
        tmp_path / "people.csv", "frame,person,x,y", "5,7,0,0", "6,7,0,0", "5,7,1,0", "5,8,99,0", "0,8,0,-99"
    )
    assert refused(dataset, path, "csv") == [
        "people.csv: line 3: frame 6 is not in the dataset",
        "people.csv: line 4: person 7 is already in frame 5, line 2 of people.csv",
        "people.csv: line 5: person 8 in frame 5 stands outside the grid",
        "people.csv: line 6: person 8 in frame 0 stands outside the grid",
    ]


def test_what_is_dropped_by_name_stays_out_and_all_else_comes_in(dataset: Dataset, tmp_path: Path) -> None:
    path = text(
        tmp_path / "people.txt", "5 40 30 7", "6 40 30 7", "5 41 30 7", "5 80 30 8", "5 40 60 9", "10 40 30 7"
    )
    report = take_in(dataset, path, "text", "back", Kind.OUTSIDE, Kind.UNKNOWN_FRAMES, Kind.DUPLICATES)
    assert content(report.layer) == {(5, 7, PLACE), (10, 7, PLACE)}
    assert report.dropped == {Kind.OUTSIDE: 2, Kind.UNKNOWN_FRAMES: 1, Kind.DUPLICATES: 1}


def test_what_does_not_fit_is_listed_up_to_a_limit_and_dropped_without(
    dataset: Dataset, tmp_path: Path
) -> None:
    path = text(tmp_path / "people.txt", "5 40 30 7", *(f"5 99 99 {person}" for person in range(8, 400)))
    assert refused(dataset, path, "text")[200:] == ["more than 200 problems, the rest is not listed"]
    assert take_in(dataset, path, "text", "back", Kind.OUTSIDE).dropped == {Kind.OUTSIDE: 392}


def test_dropping_one_kind_does_not_drop_another(dataset: Dataset, tmp_path: Path) -> None:
    path = text(tmp_path / "people.txt", "5 40 30 7", "6 40 30 7", "5 80 30 8")
    assert refused(dataset, path, "text", Kind.OUTSIDE) == [
        "people.txt: line 2: frame 6 is not in the dataset"
    ]


def test_json_files_are_told_by_file_and_entry(dataset: Dataset, tmp_path: Path) -> None:
    entries = [{"personID": 1, "positionID": PLACE}, {"personID": 1, "positionID": 4800}]
    text(tmp_path / "in" / "00000005.json", json.dumps(entries))
    text(tmp_path / "in" / "00000007.json", json.dumps(entries[:1]))
    assert refused(dataset, tmp_path / "in", "wildtrack", Kind.DUPLICATES) == [
        "00000007.json: entry 0: frame 7 is not in the dataset"
    ]
    assert refused(dataset, tmp_path / "in", "wildtrack", Kind.UNKNOWN_FRAMES) == [
        "00000005.json: entry 1: person 1 is already in frame 5, entry 0 of 00000005.json"
    ]


def test_unknown_cameras_frames_and_repeated_boxes_are_told_by_line(dataset: Dataset, tmp_path: Path) -> None:
    text(tmp_path / "in" / "C1.txt", mot_line(1, 4, 0), mot_line(1, 4, 0), mot_line(9, 4, 0))
    text(tmp_path / "in" / "C9" / "gt" / "gt.txt", mot_line(1, 4, 1))
    assert sorted(refused(dataset, tmp_path / "in", "mot")) == [
        "C1.txt: line 2: person 3 is already in this view of frame 0, line 1 of C1.txt",
        "C1.txt: line 3: frame 9 is not in the dataset",
        "C9/gt/gt.txt: line 1: the box is in a camera the dataset does not have",
    ]
    drop = (Kind.UNKNOWN_CAMERAS, Kind.UNKNOWN_FRAMES, Kind.DUPLICATES)
    assert content(take_in(dataset, tmp_path / "in", "mot", "back", *drop).layer) == {(0, 3, PLACE)}


def test_ids_of_every_view_for_itself_are_joined_where_people_stand(dataset: Dataset, tmp_path: Path) -> None:
    other = PLACE + 20
    views = {"C1": (1, 2), "C2": (2, 1), "C3": (8, 9)}  # who is at PLACE, and who at the other position
    for camera, (name, (first, second)) in enumerate(views.items()):
        lines = [mot_line(frame, first, camera) for frame in (1, 2)]
        lines += [mot_line(frame, second, camera, other) for frame in (1, 2)]
        text(tmp_path / "in" / f"{name}.txt", *lines)
    found = content(take_in(dataset, tmp_path / "in", "mot").layer)
    assert sorted((frame, position) for frame, _, position in found) == [
        (0, PLACE),
        (0, other),
        (5, PLACE),
        (5, other),
    ]
    assert len({person for _, person, position in found if position == PLACE}) == 1
    assert len({person for _, person, _ in found}) == 2


def test_detections_without_ids_become_people_of_their_own(dataset: Dataset, tmp_path: Path) -> None:
    for camera, name in enumerate(("C1", "C2", "C3")):
        box = mot_line(1, 1, camera).split(",")
        text(tmp_path / "in" / f"{name}.txt", ",".join(["1", "-1", *box[2:6], "0.9", "-1", "-1", "-1"]))
    assert {
        (frame, position) for frame, _, position in content(take_in(dataset, tmp_path / "in", "mot").layer)
    } == {(0, PLACE)}


def test_a_stated_position_is_believed_only_where_the_box_stands(dataset: Dataset, tmp_path: Path) -> None:
    camera = cameras()[0]
    xmin, ymin, xmax, ymax = (int(value) for value in boxes(PLACE)[0])
    annotation = {"id": 1, "image_id": 1, "bbox": [xmin, ymin, xmax - xmin, ymax - ymin], "person_id": 3}
    image = {"id": 1, "file_name": "C1/00000005.png", "width": camera.width, "height": camera.height}
    for layer, position in (("right", PLACE), ("wrong", PLACE + 900)):
        file = {"images": [image], "annotations": [{**annotation, "position_id": position}]}
        path = text(tmp_path / f"{layer}.json", json.dumps(file))
        assert content(take_in(dataset, path, "coco", layer).layer) == {(5, 3, PLACE)}


def test_a_file_of_one_views_boxes_alone_is_refused(dataset: Dataset, tmp_path: Path) -> None:
    path = text(tmp_path / "gt.txt", mot_line(1, 4, 0))
    assert "give the folder of all views" in refused(dataset, path, "mot")[0]


@pytest.mark.parametrize("kind", ["wildtrack", "mot", "coco", "csv", "text"])
def test_a_path_that_is_not_there_is_a_problem(dataset: Dataset, tmp_path: Path, kind: str) -> None:
    assert refused(dataset, tmp_path / "nothing", kind)


@pytest.mark.parametrize("name", ["../up", "there"])
def test_the_layers_name_must_be_new_and_plain(dataset: Dataset, tmp_path: Path, name: str) -> None:
    make_layer(dataset, "there")
    path = text(tmp_path / "people.txt", "5 40 30 7")
    with pytest.raises(ImportFailed, match="layer"):
        take_in(dataset, path, "text", name)
    assert Layer.objects.count() == 1


def test_a_height_nobody_has_is_told(dataset: Dataset, tmp_path: Path) -> None:
    path = text(tmp_path / "people.csv", "frame,person,x,y,height", "5,7,0,0,180")
    assert refused(dataset, path, "csv") == ["people.csv: line 2: height 180.0 is not one from 0.3 to 3.0 m"]


def test_the_command_lists_problems_and_takes_what_to_drop(dataset: Dataset, tmp_path: Path) -> None:
    path = text(tmp_path / "people.txt", "5 40 30 7", "6 40 30 7")
    err, out = io.StringIO(), io.StringIO()
    words = ["importannotations", "square", str(path), "--format", "text", "--layer", "theirs"]
    with pytest.raises(CommandError, match="1 problem; nothing was imported"):
        call_command(*words, stdout=out, stderr=err)
    assert "people.txt: line 2: frame 6 is not in the dataset" in err.getvalue()
    call_command(*words, "--drop", "unknown-frames", stdout=out, stderr=err)
    assert "Layer theirs: 1 annotations of 1 people in 1 frames." in out.getvalue()
    assert "Dropped (unknown-frames): 1" in out.getvalue()
