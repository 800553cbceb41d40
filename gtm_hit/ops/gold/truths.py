"""Layers that are known to be true: what others are measured by."""

from __future__ import annotations

from django.db.models import Q, QuerySet

from gtm_hit.models import Assignment, Dataset, Frame, Layer


def truths(dataset: Dataset) -> QuerySet[Layer]:
    """Everything but proposals and work that nobody accepted."""
    of_worker = Q(kind=Layer.Kind.ASSIGNMENT) & ~Q(assignment__state=Assignment.State.ACCEPTED)
    known = Layer.objects.filter(dataset=dataset).exclude(kind=Layer.Kind.PROPOSAL).exclude(of_worker)
    return known.select_related("dataset").order_by("-hidden", "name")


def frames_known(truth: Layer) -> QuerySet[Frame]:
    """Frames somebody saved in the layer, by number; also those where nobody is."""
    saved = Frame.objects.filter(layer_frames__layer=truth, layer_frames__revision__gte=1)
    return saved.order_by("number")
