"""How far a scope's ground truth is: what is accepted, what is in the layer, what waits."""

from __future__ import annotations

from dataclasses import dataclass

from django.db.models import Count, F, QuerySet

from gtm_hit.models import Batch, Frame, Job, StitchConflict, StitchedFrame, Stitching, StitchingRun
from gtm_hit.ops.stitching.scope import Scope

BINS = 200  # of the strip that shows which frames are covered


@dataclass(frozen=True)
class Overview:
    stitching: Stitching | None
    run: StitchingRun | None  # the newest
    job: Job | None  # the newest that has not ended well
    accepted: int  # assignments
    frames: int  # of the dataset
    covered: int  # by an accepted batch
    in_layer: int
    open: int  # conflicts
    open_joins: int
    decided: int
    decided_since: int  # since the last run: not yet in the layer
    strip: list[float]  # per bin of consecutive frames, the share that is covered


def overview(scope: Scope) -> Overview:
    stitching = scope.stitching()
    run = stitching.runs.select_related("job", "created_by").first() if stitching else None
    mine = StitchConflict.objects.filter(stitching=stitching) if stitching else StitchConflict.objects.none()
    states = mine.order_by().values_list("state", "kind").annotate(Count("pk"))
    counts = {(state, kind): count for state, kind, count in states}
    is_open = StitchConflict.State.OPEN.value
    waiting = sum(count for (state, _), count in counts.items() if state == is_open)
    since = mine.filter(decided_at__gt=run.created_at).count() if run else 0
    covered, strip = _covered(scope)
    return Overview(
        stitching=stitching,
        run=run,
        job=_job(scope),
        accepted=scope.accepted().count(),
        frames=scope.dataset.frames.count(),
        covered=covered,
        in_layer=StitchedFrame.objects.filter(layer=stitching.layer_id).count() if stitching else 0,
        open=waiting,
        open_joins=counts.get((is_open, StitchConflict.Kind.JOIN.value), 0),
        decided=sum(counts.values()) - waiting,
        decided_since=since,
        strip=strip,
    )


def conflicts(scope: Scope, state: str = "") -> QuerySet[StitchConflict]:
    """Joins first, then returns; each along the dataset. The surest joins come last among joins at a time."""
    found = StitchConflict.objects.filter(
        stitching__dataset=scope.dataset, stitching__campaign=scope.campaign
    ).select_related("stitching__dataset", "stitching__layer", "decided_by")
    found = found.order_by("kind", "left_at", F("lead").asc(nulls_last=True), "pk")
    return found.filter(state=state) if state else found


def _job(scope: Scope) -> Job | None:
    campaign = scope.campaign.pk if scope.campaign else None
    jobs = Job.objects.filter(dataset=scope.dataset, kind=Job.Kind.STITCH).order_by("-pk")
    found = next((job for job in jobs[:20] if job.parameters.get("campaign_id") == campaign), None)
    return found if found and found.state != Job.State.DONE else None


def _covered(scope: Scope) -> tuple[int, list[float]]:
    batches = scope.accepted().order_by().values("batch_id")
    links = Batch.frames.through.objects.filter(batch__in=batches)
    covered = set(links.values_list("frame_id", flat=True))
    frames = list(Frame.objects.filter(dataset=scope.dataset).order_by("number").values_list("pk", flat=True))
    bins = min(BINS, len(frames))
    strip = []
    for index in range(bins):
        part = frames[index * len(frames) // bins : (index + 1) * len(frames) // bins]
        strip.append(sum(pk in covered for pk in part) / len(part))
    return len(covered), strip
