"""Two datasets, and what the addresses of the table are filled with."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from django.contrib.auth.models import User
from django.core.files.base import ContentFile
from django.core.files.storage import default_storage

from gtm_hit.models import (
    Assignment,
    BoardPicture,
    ClickFile,
    Dataset,
    Desk,
    DeskAdjustment,
    Job,
    Layer,
    ProposalRun,
    Release,
)
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.desk import desks, kept
from gtm_hit.ops.desk import points as desk_points
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.desk.kept import SeenAt
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.ground import grid_files
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.work import assignments, batches, links
from tests.access.campaign_scene import campaign_fills
from tests.work_scene import make_dataset, make_layer, make_worker, row, save

HERE, ELSEWHERE = "square", "elsewhere"
SECRET = "secret-truth"  # the name of the hidden layers
BOARD = "calibration-board.<slug:kind>"  # a sheet for every dataset


@dataclass(frozen=True)
class Place:
    """One dataset with an example for everything that an address may name."""

    dataset: Dataset
    assignment: Assignment
    layer: Layer
    hidden: Layer
    fills: dict[str, str] = field(default_factory=dict)

    def address(self, route: str) -> str:
        """Filled by the first line that fits, longer ones first. Raises KeyError where none does."""
        path = route.replace("^", "").replace("$", "").replace(r"\.", ".")
        for part in sorted(self.fills, key=len, reverse=True):
            path = path.replace(part, self.fills[part])
        if left := re.search(r"<.+?>", path):
            raise KeyError(
                f"{route}: the scene has no example for {left[0]}; add one to tests/access/scene.py"
            )
        return "/" + path

    def within(self, route: str) -> bool:
        """Whether the address names something that belongs to a dataset."""
        return self.address(route) != "/" + route and BOARD not in route


def make_place(slug: str) -> Place:
    dataset = make_dataset(slug, frames=12, images=True)
    # Cameras of its own, so that its grid files are no other dataset's.
    dataset.cameras.update(tvec=[0.0, 1.0, 12.0 + len(slug)])
    batches.make_batches(dataset, size=4)
    assignment = assignments.claim(make_worker(f"of-{slug}"), dataset)
    layer, hidden = make_layer(dataset), make_layer(dataset, SECRET, Layer.Kind.GROUND_TRUTH, hidden=True)
    for each in (layer, hidden):
        save(each, dataset.frames.all()[0], [row()])
    fills = fills_of(dataset, assignment, layer) | campaign_fills(dataset, layer, hidden)
    return Place(dataset, assignment, layer, hidden, fills)


def fills_of(dataset: Dataset, assignment: Assignment, layer: Layer) -> dict[str, str]:
    """By the part of an address; to add an example, add a line."""
    change = queue.create(Job.Kind.REPLACE_CALIBRATION, dataset, {})
    Release.objects.create(
        dataset=dataset,
        number=1,
        layer=make_layer(dataset, "released", Layer.Kind.GROUND_TRUTH),
        manifest={
            "counts": {"frames": 1, "people": 1, "annotations": 1, "cameras": 2},
            "files": {},
            "parameters": {},
        },
        manifest_digest="0" * 64,
    )
    picture = dataset.frames.all()[0].images.all()[0].light_digest
    default_storage.save(f"images/{picture[:2]}/{picture}.jpg", ContentFile(b"picture"))
    grid = grid_files.digest_of(dataset, dataset.calibrated_cameras()[0])
    run = ProposalRun.objects.create(dataset=dataset, method=ProposalRun.Method.BACKGROUND, digest="0" * 64)
    desk = f"calibration-desks/desk-of-{dataset.slug}"
    board_picture = desk_of(dataset, desk.partition("/")[2], picture)
    return {
        "calibration-desks/<slug:desk>": desk,
        "boards/<int:picture>": f"boards/{board_picture.pk}",
        BOARD: "calibration-board.svg?kind=chessboard&columns=9&rows=6&spacing=0.03",
        "cameras/<str:camera>": "cameras/C1",
        "adjust/<slug:what>": "adjust/undo",
        "files/<str:digest>": "files/0",
        "results/<int:result>": "results/1",
        "lens/<str:camera>": "lens/C1",
        "lens/<str:camera>/<slug:what>": "lens/C1/choose",
        "pictures/<int:picture>": f"pictures/{board_picture.pk}",
        "clicks/<str:point>": "clicks/A1",
        "clicks/<str:camera>": "clicks/C1",
        "named/<str:point>": "named/A1",
        "pictures/(?P<digest>[0-9a-f]{64})": f"pictures/{picture}",
        "proposals/<int:number>": f"proposals/{run.pk}",
        "datasets/<slug:slug>": f"datasets/{dataset.slug}",
        "layers/<str:name>": f"layers/{layer.name}",
        "layers/<int:layer>": f"layers/{layer.pk}",
        "calibration/<int:pk>": f"calibration/{change.pk}",
        "calibrations/<int:pk>": f"calibrations/{change.pk}",
        "jobs/<int:pk>": f"jobs/{exporting.start(layer).pk}",
        "tokens/<int:pk>": "tokens/1",
        "video-syncs/<int:pk>": "video-syncs/1",
        "videos/<int:video>": "videos/0",
        "versions/<int:number>": "versions/1",
        "releases/<int:number>/<str:name>": "releases/1/README.md",
        "releases/<int:number>": "releases/1",
        "files/<str:name>": "files/README.md",
        "statistics/<slug:figure>.<slug:kind>": "statistics/speeds.svg",
        "statistics/<slug:name>": "statistics/speeds",
        "frames/<int:number>": "frames/0",
        "from/<int:first>": "from/0",
        "coverage/<str:digest>": "coverage/0",
        "images/(?P<digest>[0-9a-f]{64})": f"images/{picture}",
        "grids/(?P<digest>[0-9a-f]{64})": f"grids/{grid}",
        "join/<str:token>": f"join/{links.entry_token(dataset)}",
        "work/<str:token>": f"work/{links.worker_token(assignment.worker, dataset)}",
        "annotate/<str:token>": f"annotate/{links.assignment_token(assignment)}",
    }


def desk_of(dataset: Dataset, slug: str, picture: str) -> BoardPicture:
    made = desks.make(slug, dataset=dataset)
    desk_points.put(made, "A1", 0.0, 0.0)
    kept.keep(made, [SeenAt(each.name, 1.0, 1.0) for each in made.cameras.all()], "test", "A1")
    camera = made.cameras.all()[0]
    adjusted(made)
    values = {"light_digest": picture, "full_digest": picture, "width": 1920, "height": 1080}
    return BoardPicture.objects.create(camera=camera, name="board.png", source_digest=picture, **values)


def adjusted(desk: Desk) -> None:
    """A result there is, of cameras that there are not, and a file of clicks."""
    ClickFile.objects.create(desk=desk, digest="0", name="clicks.zip", used=True, points=[])
    DeskAdjustment.objects.create(
        desk=desk,
        number=1,
        of="0" * 64,
        choices=Choices().as_json(),
        inputs={"clicks": [], "measured": {}, "cameras": {}},
        report={"cost": 1.0, "median_px": 1.0, "monotone": True, "feet": None, "worst": [], "cameras": []},
        cameras={},
    )


def somebody(name: str, role: Role | None = None, dataset: Dataset | None = None) -> User:
    user = User.objects.create_user(name)
    if role:
        granting.grant(user, role, dataset)
    return user
