"""A desk with a dataset of two cameras, a grid of measured points, and where they are really seen."""

from __future__ import annotations

from typing import Any

from gtm_hit.geometry.camera import project
from gtm_hit.models import Dataset, Desk
from gtm_hit.ops.desk import clicks, desks, ground
from tests.work_scene import make_dataset


def make_desk(dataset: Dataset | None = None, **values: Any) -> Desk:
    """15 points, a metre and a half apart in X, two in Y: A1 … E3; no click yet."""
    dataset = dataset or make_dataset(images=True)
    desk = desks.make(values.pop("slug", "plaza"), "The plaza", dataset, **values)
    ground.put_grid(desk, 5, 3, (1.5, 2.0), (-3.0, -2.0))
    return desk


def seen(desk: Desk, camera: str = "C1") -> dict[str, tuple[float, float]]:
    """Where the dataset's camera in place sees each point, rounded as a hand would: to half a pixel."""
    assert desk.dataset is not None
    view = desk.dataset.cameras.get(name=camera).calibrated
    rows = list(desk.points.all())
    pixels = project(view, [(each.x, each.y, each.z) for each in rows])
    return {
        each.name: (round(2 * x) / 2, round(2 * y) / 2)
        for each, (x, y) in zip(rows, pixels.tolist(), strict=True)
        if 0 <= x < view.width and 0 <= y < view.height
    }


def click(desk: Desk, names: str, camera: str = "C1") -> None:
    """Names with blanks between them."""
    places = seen(desk, camera)
    for name in names.split():
        clicks.put(desk, camera, name, *places[name])
