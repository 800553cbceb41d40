"""Out in a format, in again: nothing changed. And the field's own readers take the files."""

from __future__ import annotations

import contextlib
import io
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.core.management import call_command

from gtm_hit.demo.render import truth
from gtm_hit.demo.scene import read_scene
from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.formats.manifest import verify
from gtm_hit.models import Dataset, Frame, Layer, LayerFrame
from gtm_hit.ops.datasets import demo
from gtm_hit.ops.datasets.importing import ImportFailed
from gtm_hit.ops.datasets.rows import add_cameras
from gtm_hit.ops.ground.coverage import table
from tests.formats.pom_reader import read_pom
from tests.ops.square_layer import content, export, fill, make_square, save, take_in
from tests.work_scene import make_layer, row

pytestmark = pytest.mark.django_db

WAYS: dict[str, tuple[str, str, str]] = {  # the format of the export, what of it is taken in, and as what
    "wildtrack": ("wildtrack", "", "wildtrack"),
    "multiviewx": ("multiviewx", "multiviewx", "wildtrack"),
    "csv": ("csv", "people.csv", "csv"),
    "text": ("text", "frame_column_row/people.txt", "text"),
    "mot": ("mot", "mot", "mot"),
    "mot on the ground": ("mot", "mot/ground/gt/gt.txt", "mot"),
    "coco": ("coco", "coco", "coco"),
}


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.MEDIA_ROOT = tmp_path / "media"
    settings.TABLES_ROOT = tmp_path / "tables"


@pytest.fixture
def dataset() -> Dataset:
    return make_square()


@pytest.fixture
def layer(dataset: Dataset) -> Layer:
    layer = make_layer(dataset, "truth")
    fill(layer)
    return layer


@pytest.fixture(params=["corners", "centre"])
def square(request: pytest.FixtureRequest) -> Layer:
    layer = make_layer(make_square(foot_rule=request.param), "truth")
    fill(layer)
    return layer


@pytest.fixture
def multiviewx(shared_data: Path) -> Layer:
    call_command(
        "importdataset",
        "mvx",
        str(shared_data / "multiviewx"),
        "--preset",
        "multiviewx",
        stdout=io.StringIO(),
    )
    return Layer.objects.select_related("dataset").get(dataset__slug="mvx")


def without_ground(folder: Path) -> None:
    shutil.rmtree(folder / "mot" / "ground")


def without_positions(folder: Path) -> None:
    for path in (folder / "coco").iterdir():
        found = json.loads(path.read_text())
        for box in found["annotations"]:
            del box["position_id"]
        path.write_text(json.dumps(found))


def without_people(folder: Path) -> None:
    for path in (folder / "coco").iterdir():
        path.write_text(path.read_text().replace('"person_id"', '"number"'))


def positions(layer: Layer) -> list[tuple[int, int]]:
    return sorted((frame, position) for frame, _person, position in content(layer))


@pytest.mark.parametrize("way", WAYS)
def test_nothing_changes_on_the_way_out_and_in(square: Layer, tmp_path: Path, way: str) -> None:
    kind, part, reader = WAYS[way]
    folder = export(square, tmp_path / "out", kind)
    assert verify(folder) == []
    back = take_in(square.dataset, folder / part, reader)
    assert content(back.layer) == content(square)
    assert back.dropped == {}


@pytest.mark.parametrize(("kind", "reader"), sorted({(kind, reader) for kind, _, reader in WAYS.values()}))
def test_the_whole_folder_of_an_export_is_taken_in(
    layer: Layer, tmp_path: Path, kind: str, reader: str
) -> None:
    back = take_in(layer.dataset, export(layer, tmp_path / "out", kind), reader)
    assert content(back.layer) == content(layer)


def test_every_format_of_one_export_is_found_in_it(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out", "wildtrack", "mot", "coco", "csv", "text")
    for reader in ("wildtrack", "mot", "coco", "csv", "text"):
        assert content(take_in(layer.dataset, folder, reader, reader).layer) == content(layer)


def test_a_link_out_of_the_folder_is_not_followed(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out", "mot")
    (folder / "mot").rename(tmp_path / "elsewhere")
    (folder / "mot").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(ImportFailed):
        take_in(layer.dataset, folder, "mot")
    assert not Layer.objects.filter(name="back").exists()


def test_multiviewx_comes_back_as_it_went_in_every_format(multiviewx: Layer, tmp_path: Path) -> None:
    folder = export(multiviewx, tmp_path / "out", *dict.fromkeys(kind for kind, _, _ in WAYS.values()))
    for way, (_kind, part, reader) in WAYS.items():
        back = take_in(multiviewx.dataset, folder / part, reader, way.replace(" ", "-"))
        assert content(back.layer) == content(multiviewx), way


@pytest.fixture
def demo_scene() -> Layer:
    """The hidden truth of the demo scene: seven real poses, twenty frames, people of their own heights."""
    scene = read_scene()
    dataset = Dataset.objects.create(
        slug="demo",
        name="Demo scene",
        frame_rate=scene.numbers_per_second,
        frame_step=scene.number_step,
        **{name: getattr(scene.grid, name) for name in ("columns", "rows", "step", "origin_x", "origin_y")},
    )
    add_cameras(dataset, load_cameras(demo.CAMERAS))
    layer = make_layer(dataset, "truth", Layer.Kind.GROUND_TRUTH)
    people: dict[int, list[Any]] = {number: [] for number in scene.frame_numbers}
    for each in truth(scene):
        people[each.number].append(row(each.person, each.position, height=round(each.height, 2)))
    for number, rows in people.items():
        Frame.objects.create(dataset=dataset, number=number)
        save(layer, number, rows)
    return layer


def test_the_demo_scene_comes_back_as_it_went_in_every_format(demo_scene: Layer, tmp_path: Path) -> None:
    folder = export(demo_scene, tmp_path / "out", *dict.fromkeys(kind for kind, _, _ in WAYS.values()))
    assert verify(folder) == []
    for way, (_kind, part, reader) in WAYS.items():
        back = take_in(demo_scene.dataset, folder / part, reader, way.replace(" ", "-"))
        assert content(back.layer) == content(demo_scene), way
    for way in ("wildtrack", "multiviewx", "csv"):  # these say how tall people are
        back = Layer.objects.get(name=way)
        assert content(back, "position", "height") == content(demo_scene, "position", "height"), way


def test_boxes_alone_lead_back_to_every_position_of_multiviewx(multiviewx: Layer, tmp_path: Path) -> None:
    folder = export(multiviewx, tmp_path / "out", "mot", "coco")
    dataset = multiviewx.dataset
    without_ground(folder)
    assert content(take_in(dataset, folder / "mot", "mot", "mot").layer) == content(multiviewx)
    without_positions(folder)
    assert content(take_in(dataset, folder / "coco", "coco", "coco").layer) == content(multiviewx)
    without_people(folder)
    unnamed = take_in(dataset, folder / "coco", "coco", "unnamed").layer
    assert positions(unnamed) == positions(multiviewx)


@pytest.mark.parametrize(
    ("kind", "change"), [("mot", without_ground), ("coco", without_positions)], ids=["mot", "coco"]
)
def test_boxes_alone_lead_back_to_the_positions(
    square: Layer, tmp_path: Path, kind: str, change: Callable[[Path], None]
) -> None:
    folder = export(square, tmp_path / "out", kind)
    change(folder)
    assert content(take_in(square.dataset, folder / kind, kind).layer) == content(square)


@pytest.mark.parametrize(("kind", "part"), [("wildtrack", ""), ("csv", "people.csv")])
def test_heights_of_their_own_survive(dataset: Dataset, tmp_path: Path, kind: str, part: str) -> None:
    layer = make_layer(dataset, "children")
    fill(layer, height=1.23)
    folder = export(layer, tmp_path / "out", kind)
    back = take_in(dataset, folder / part, kind).layer
    assert content(back, "position", "height") == content(layer, "position", "height")


@pytest.mark.parametrize(("kind", "part"), [("mot", "mot"), ("coco", "coco")])
def test_people_of_another_height_stay_where_they_are(
    dataset: Dataset, tmp_path: Path, kind: str, part: str
) -> None:
    layer = make_layer(dataset, "children")
    fill(layer, height=1.23)
    folder = export(layer, tmp_path / "out", kind)
    assert content(take_in(dataset, folder / part, kind).layer) == content(layer)


@pytest.mark.parametrize(("kind", "part"), [("wildtrack", ""), ("coco", "coco")])
def test_a_frame_with_nobody_comes_back_as_one(layer: Layer, tmp_path: Path, kind: str, part: str) -> None:
    back = take_in(layer.dataset, export(layer, tmp_path / "out", kind) / part, kind).layer
    assert LayerFrame.objects.get(layer=back, nobody=True).frame.number == 15


def test_an_imported_layer_is_exported_to_the_same_bytes(layer: Layer, tmp_path: Path) -> None:
    first = take_in(layer.dataset, export(layer, tmp_path / "one", "wildtrack"), "wildtrack", "first").layer
    second = take_in(layer.dataset, export(first, tmp_path / "two", "wildtrack"), "wildtrack", "second").layer
    again = export(second, tmp_path / "three", "wildtrack")
    for path in sorted((tmp_path / "two" / "annotations_positions").iterdir()):
        assert (again / "annotations_positions" / path.name).read_bytes() == path.read_bytes()


def test_all_formats_go_into_one_export(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out", "wildtrack", "multiviewx", "pom", "mot", "coco", "csv", "text")
    assert verify(folder) == []
    readme = (folder / "README.txt").read_text()
    names = {path.relative_to(folder).parts[0] for path in folder.rglob("*") if path.is_file()}
    assert names >= {"annotations_positions", "multiviewx", "rectangles.pom", "mot", "coco", "people.csv"}
    assert all(name in readme for name in names - {"README.txt"})


def test_rectangles_are_those_of_the_table(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out", "pom", "multiviewx")
    dataset = layer.dataset
    found = read_pom(folder / "rectangles.pom")
    assert (found.header.grid, found.header.cameras) == (dataset.grid, 3)
    expected = table(dataset)
    for camera in range(3):
        assert (found.boxes[camera] == expected.boxes(camera)).all()
    headless = (folder / "multiviewx" / "rectangles.pom").read_text()
    assert headless.startswith("RECTANGLE 0 0 ")
    assert (folder / "rectangles.pom").read_text().endswith(headless)


def test_pycocotools_reads_what_is_written(layer: Layer, tmp_path: Path) -> None:
    coco = pytest.importorskip("pycocotools.coco")
    folder = export(layer, tmp_path / "out", "coco")
    boxes = 0
    for name in ("C1", "C2", "C3"):
        with contextlib.redirect_stdout(io.StringIO()):
            found = coco.COCO(str(folder / "coco" / f"{name}.json"))
        assert len(found.getImgIds()) == 4
        assert found.loadCats(found.getCatIds())[0]["name"] == "person"
        boxes += len(found.loadAnns(found.getAnnIds(iscrowd=False)))
    seen = json.loads((export(layer, tmp_path / "json", "wildtrack") / "manifest.json").read_text())
    assert seen["counts"]["annotations"] <= boxes == visible_boxes(tmp_path / "json")


def test_motmetrics_reads_what_is_written(layer: Layer, tmp_path: Path) -> None:
    motmetrics = pytest.importorskip("motmetrics")
    folder = export(layer, tmp_path / "out", "mot", "wildtrack")
    tables = [
        motmetrics.io.loadtxt(str(folder / "mot" / name / "gt" / "gt.txt"), fmt="mot16")
        for name in ("C1", "C2", "C3")
    ]
    assert sum(map(len, tables)) == visible_boxes(folder)
    assert {frame for table in tables for frame, _ in table.index} == {1, 2, 3}
    accumulated = motmetrics.MOTAccumulator(auto_id=True)
    for _frame, rows in tables[0].groupby(level=0):
        ids, left = rows.index.get_level_values(1).tolist(), rows["X"].to_numpy()
        accumulated.update(ids, ids, np.abs(left[:, None] - left[None, :]))
    score = motmetrics.metrics.create().compute(accumulated, metrics=["mota", "idf1"])
    assert score.iloc[0].tolist() == [1.0, 1.0]


def visible_boxes(folder: Path) -> int:
    return sum(
        view["xmin"] != -1
        for path in (folder / "annotations_positions").iterdir()
        for person in json.loads(path.read_text())
        for view in person["views"]
    )
