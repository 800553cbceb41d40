"""A desk of some of the demo plaza's cameras, clicked by a trembling hand, and where they truly stand."""

from __future__ import annotations

import numpy as np

from gtm_hit.calibration.checking import shown
from gtm_hit.geometry.camera import Camera
from gtm_hit.models import Click, Desk, KeptClick, KeptPoint, MeasuredPoint
from gtm_hit.ops.desk import desks, poses
from tests.check_scene import truth
from tests.work_scene import digest

CAMERAS = ("C1", "C3", "C4", "C5")
MEASURED = 9  # pairs a camera
TREMBLE = 2.0  # pixels, of clicks on the ground; those of kept points are steadier


def noisy_desk(
    slug: str = "plaza", points: int = 40, cameras: tuple[str, ...] = CAMERAS, lens_off: float = 0.0
) -> Desk:
    """Each camera stands a little beside its true place; `points` seen by several of them are kept."""
    random = np.random.default_rng(7)
    true = {name: truth()[name] for name in cameras}
    desk = desks.make(slug, "The plaza", cameras=list(true))
    measured = [
        MeasuredPoint.objects.create(desk=desk, number=number, name=f"M{number}", x=x, y=y, z=0.0)
        for number, (x, y) in enumerate([(x, y) for x in (0.0, 3.0, 6.0, 9.0) for y in range(0, 24, 3)], 1)
    ]
    for row in desk.cameras.all():
        camera = true[row.name]
        matrix = camera.matrix.copy()
        matrix[0, 0] *= 1 + lens_off
        matrix[1, 1] *= 1 + lens_off
        row.width, row.height = camera.width, camera.height
        row.lens = {
            "matrix": matrix.tolist(),
            "distortion": camera.distortion.tolist(),
            "source": "the demo",
        }
        row.light_digest = row.full_digest = digest(row.name.encode())
        row.save()
        pairs = [(point, spot(camera, (point.x, point.y, 0.0))) for point in measured]
        chosen = [(point, place) for point, place in pairs if place is not None]
        for place in random.permutation(len(chosen))[:MEASURED]:
            point, (x, y) = chosen[int(place)]
            dx, dy = random.normal(0, TREMBLE, 2).tolist()
            Click.objects.create(camera=row, point=point, x=x + dx, y=y + dy)
        poses.solve(row)
    keep_points(desk, points, random)
    return desk


def keep_points(
    desk: Desk,
    count: int,
    random: np.random.Generator,
    use: KeptPoint.Use = KeptPoint.Use.CORRESPONDENCE,
    stem: str = "P",
) -> None:
    """Things anywhere on the plaza, up to 2 m high, clicked in all views that show them."""
    rows = list(desk.cameras.all())
    made = 0
    while made < count:
        place = (random.uniform(-2, 9), random.uniform(-2, 22), random.uniform(0, 2))
        seen = [(row, spot(truth()[row.name], place)) for row in rows]
        views = [(row, at) for row, at in seen if at is not None]
        if len(views) < 2:
            continue
        made += 1
        point = KeptPoint.objects.create(desk=desk, name=f"{stem}{made}", use=use)
        for row, (x, y) in views:
            dx, dy = random.normal(0, 0.5, 2).tolist()
            KeptClick.objects.create(point=point, camera=row, x=x + dx, y=y + dy)


def spot(camera: Camera, place: tuple[float, float, float]) -> tuple[float, float] | None:
    """Where it is seen, well inside the picture; None where it is not."""
    x, y = shown(camera, np.array(place)).tolist()
    inside = 60 < x < camera.width - 60 and 60 < y < camera.height - 60
    return (x, y) if inside else None


def misplaced(desk: Desk) -> float:
    """Metres by which the desk's cameras stand beside their true places, the mean of all."""
    rows = list(desk.cameras.all())
    found = [(truth()[row.name], poses.calibrated(row)) for row in rows]
    return float(np.mean([np.linalg.norm(one.centre - other.centre) for one, other in found if other]))
