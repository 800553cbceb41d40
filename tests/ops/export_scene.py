"""A layer long enough to be interrupted while it is exported.

Run as a program (`python -m tests.ops.export_scene build|start`) inside the site a test has made.
"""

from __future__ import annotations

import os
import sys

import django

SLUG, LAYER = "long", "people"
FRAMES, PEOPLE = 1200, 12


def build() -> None:
    from gtm_hit.models import Annotation, LayerFrame
    from tests.work_scene import make_dataset, make_layer

    dataset = make_dataset(SLUG, frames=FRAMES)
    layer = make_layer(dataset, LAYER)
    frames = list(dataset.frames.all())
    LayerFrame.objects.bulk_create(LayerFrame(layer=layer, frame=frame, revision=1) for frame in frames)
    Annotation.objects.bulk_create(
        (
            Annotation(
                layer=layer,
                frame=frame,
                person=person,
                position=(frame.number * 7 + person * 13337) % dataset.grid.count,
                height=1.6 if person == 3 else None,
            )
            for frame in frames
            for person in range(PEOPLE)
        ),
        batch_size=5000,
    )


def start() -> None:
    from gtm_hit.models import Layer
    from gtm_hit.ops.exports import exporting

    print(exporting.start(Layer.objects.select_related("dataset").get(name=LAYER)).pk)


if __name__ == "__main__":
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
    django.setup()
    {"build": build, "start": start}[sys.argv[1]]()
