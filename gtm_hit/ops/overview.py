"""The numbers of the staff pages, each page with a constant number of queries."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from django.db.models import Case, Count, OuterRef, QuerySet, Subquery, When
from django.utils import timezone

from gtm_hit.models import (
    Annotation,
    Assignment,
    Batch,
    Camera,
    Campaign,
    Dataset,
    Frame,
    Image,
    Job,
    Layer,
    LayerFrame,
)
from gtm_hit.ops.access.roles import Somebody, datasets_of, layers_of
from gtm_hit.ops.counting import correlated_count as _count


@dataclass(frozen=True)
class DatasetSummary:
    dataset: Dataset
    cameras: int
    frames: int
    annotated: int  # frames somebody finished, in a layer that is not hidden
    batches: int
    layers: int
    first_number: int | None
    last_number: int | None
    pictures: list[Image]  # the first frame's, by camera


def datasets(user: Somebody) -> list[DatasetSummary]:
    """Those that somebody sees, with the layers he may read."""
    return _summaries(datasets_of(user), layers_of(user))


def dataset(slug: str, user: Somebody) -> DatasetSummary | None:
    return next(iter(_summaries(datasets_of(user).filter(slug=slug), layers_of(user))), None)


def layers(dataset: Dataset) -> QuerySet[Layer]:
    """Layers with `frames_saved`, `frames_done`, `annotation_count`, `people` and `changed_at`.

    The many of the workers come after the few that were imported, released or made by staff.
    """
    saved = LayerFrame.objects.filter(layer=OuterRef("pk"), revision__gte=1)
    annotations = Annotation.objects.filter(layer=OuterRef("pk"))
    return dataset.layers.annotate(
        frames_saved=_count(saved, "layer", "pk"),
        frames_done=_count(saved.filter(done=True), "layer", "pk"),
        annotation_count=_count(annotations, "layer", "pk"),
        people=_count(annotations, "layer", "person", distinct=True),
        changed_at=Subquery(saved.order_by("-changed_at").values("changed_at")[:1]),
        of_worker=Case(When(kind=Layer.Kind.ASSIGNMENT, then=1), default=0),
    ).order_by("of_worker", "name")


@dataclass(frozen=True)
class BatchCounts:
    batches: int
    free: int
    leased: int
    submitted: int
    accepted: int
    frames_without: int  # frames in no batch


def batch_counts(dataset: Dataset) -> BatchCounts:
    """Of the batches made for the dataset itself; campaigns count their own."""
    held = Assignment.objects.filter(
        batch__dataset=dataset,
        batch__campaign=None,
        batch__qualification=None,
        state__in=Assignment.HOLDING,
    )
    states = dict(
        # A lease that ran out holds nothing, though its row says so until the clock comes by.
        held.exclude(state=Assignment.State.LEASED, expires_at__lte=timezone.now())
        .values_list("state")
        .annotate(count=Count("pk"))
        .order_by()
    )
    own = dataset.batches.filter(campaign=None)
    batches = own.count()
    return BatchCounts(
        batches=batches,
        free=batches - sum(states.values()),
        leased=states.get("leased", 0) + states.get("returned", 0),
        submitted=states.get("submitted", 0),
        accepted=states.get("accepted", 0),
        frames_without=dataset.frames.exclude(batches__in=own).count(),
    )


def batches(dataset: Dataset, campaign: Campaign | None = None) -> QuerySet[Batch]:
    """Batches with `frame_count`, `first_number` and `last_number`; pages hand out `with_assignments`."""
    frames = Frame.objects.filter(batches=OuterRef("pk"))
    return (
        dataset.batches.filter(campaign=campaign)
        .annotate(
            frame_count=_count(Batch.frames.through.objects.filter(batch=OuterRef("pk")), "batch", "pk"),
            first_number=Subquery(frames.order_by("number").values("number")[:1]),
            last_number=Subquery(frames.order_by("-number").values("number")[:1]),
        )
        .order_by("copy", "number")
    )


@dataclass(frozen=True)
class BatchRow:
    batch: Batch
    assignment: Assignment | None  # who holds it, else who had it last; with `frames_done` and `people`

    @property
    def state(self) -> str:
        """The assignment's state, or `free` when anybody may have the batch."""
        if self.assignment is None or self.assignment.state not in Assignment.HOLDING:
            return "free"
        if self.assignment.state == Assignment.State.LEASED and self.assignment.expires_at <= timezone.now():
            return Assignment.State.EXPIRED
        return self.assignment.state


def with_assignments(batches: Iterable[Batch]) -> list[BatchRow]:
    """Two queries, however many batches."""
    done = LayerFrame.objects.filter(layer=OuterRef("layer"), done=True)
    annotations = Annotation.objects.filter(layer=OuterRef("layer"))
    assignments = (
        Assignment.objects.filter(batch__in=list(batches))
        .select_related("worker", "layer")
        .annotate(
            frames_done=_count(done, "layer", "pk"),
            people=_count(annotations, "layer", "person", distinct=True),
        )
        .order_by("-leased_at")
    )
    newest: dict[int, list[Assignment]] = {}
    for assignment in assignments:
        newest.setdefault(assignment.batch_id, []).append(assignment)
    rows = []
    for batch in batches:
        mine = newest.get(batch.pk, [])
        held = next((a for a in mine if a.state in Assignment.HOLDING), None)
        rows.append(BatchRow(batch, held or next(iter(mine), None)))
    return rows


def assignments(dataset: Dataset) -> QuerySet[Assignment]:
    """Assignments with `frame_count`, `frames_done` and `people`, the newest first."""
    frames = Batch.frames.through.objects.filter(batch=OuterRef("batch"))
    done = LayerFrame.objects.filter(layer=OuterRef("layer"), done=True)
    annotations = Annotation.objects.filter(layer=OuterRef("layer"))
    return (
        Assignment.objects.filter(batch__dataset=dataset, batch__qualification=None)
        .select_related("batch", "worker", "layer")
        .annotate(
            frame_count=_count(frames, "batch", "pk"),
            frames_done=_count(done, "layer", "pk"),
            people=_count(annotations, "layer", "person", distinct=True),
        )
        .order_by("-leased_at", "-pk")
    )


def jobs() -> QuerySet[Job]:
    return Job.objects.select_related("dataset", "created_by")


def _summaries(found: QuerySet[Dataset], layers: QuerySet[Layer]) -> list[DatasetSummary]:
    frames = Frame.objects.filter(dataset=OuterRef("pk")).order_by("number")
    finished = LayerFrame.objects.filter(
        layer__dataset=OuterRef("pk"), layer__hidden=False, layer__unfinished=False, done=True
    )
    rows = list(
        found.annotate(
            camera_count=_count(Camera.objects.filter(dataset=OuterRef("pk")), "dataset", "pk"),
            frame_count=_count(frames.order_by(), "dataset", "pk"),
            annotated_count=_count(finished, "layer__dataset", "frame", distinct=True),
            batch_count=_count(Batch.objects.filter(dataset=OuterRef("pk")), "dataset", "pk"),
            layer_count=_count(layers.filter(dataset=OuterRef("pk")), "dataset", "pk"),
            first_frame=Subquery(frames.values("pk")[:1]),
            first_number=Subquery(frames.values("number")[:1]),
            last_number=Subquery(frames.reverse().values("number")[:1]),
        )
    )
    pictures: dict[int, list[Image]] = {}
    for image in (
        Image.objects.filter(frame__in=[row.first_frame for row in rows if row.first_frame])
        .select_related("camera")
        .order_by("camera__index")
    ):
        pictures.setdefault(image.frame_id, []).append(image)
    return [
        DatasetSummary(
            dataset=row,
            cameras=row.camera_count,
            frames=row.frame_count,
            annotated=row.annotated_count,
            batches=row.batch_count,
            layers=row.layer_count,
            first_number=row.first_number,
            last_number=row.last_number,
            pictures=pictures.get(row.first_frame, []),
        )
        for row in rows
    ]
