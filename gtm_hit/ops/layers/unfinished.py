"""A layer that is filled part by part and appears at once.

Long transactions would let everybody wait who saves (SQLite), and hide how far the import is (PostgreSQL).
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime, timedelta
from uuid import uuid4

from django.db import transaction

from gtm_hit.models import Annotation, Dataset, Layer, LayerFrame, Save

FRAMES_AT_ONCE = 500
LONGEST = timedelta(days=1)  # no import takes as long


@contextmanager
def layer(dataset: Dataset, hidden: bool, kind: str = Layer.Kind.IMPORTED) -> Iterator[Layer]:
    """A layer nobody sees until `appear`; gone when the block fails."""
    # A name of its own: two imports at once, or the rest of a killed one, are not in each other's way.
    made = Layer.with_unfinished.create(
        dataset=dataset,
        name=f"unfinished-{uuid4().hex}",
        kind=kind,
        hidden=hidden,
        unfinished=True,
    )
    try:
        yield made
    except BaseException:
        remove(made)
        raise


def appear(made: Layer, name: str) -> None:
    """Raises IntegrityError where the dataset has a layer of this name."""
    made.name, made.unfinished = name, False
    Layer.with_unfinished.filter(pk=made.pk).update(name=name, unfinished=False)


def remove(made: Layer) -> None:
    """With all that is in it, part by part."""
    while parts := list(LayerFrame.objects.filter(layer=made.pk).values_list("pk", "frame")[:FRAMES_AT_ONCE]):
        heads, frames = zip(*parts, strict=True)
        with transaction.atomic():
            Annotation.objects.filter(layer=made.pk, frame__in=frames).delete()
            Save.objects.filter(layer_frame__in=heads).delete()
            LayerFrame.objects.filter(pk__in=heads).delete()
    Layer.with_unfinished.filter(pk=made.pk).delete()


def remove_abandoned(now: datetime) -> None:
    """What killed imports left."""
    for made in Layer.with_unfinished.filter(unfinished=True, created_at__lt=now - LONGEST):
        remove(made)
