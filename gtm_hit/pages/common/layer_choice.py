"""Choosing layers by name in a form."""

from __future__ import annotations

from django.db.models import Case, QuerySet, Value, When

from gtm_hit.models import Dataset, Layer
from gtm_hit.ops.access.roles import Somebody, layers_of

LAYERS_SHOWN = 200  # in a list to choose from; others are reached by their name in the address


def layers_by_importance(dataset: Dataset, user: Somebody) -> QuerySet[Layer]:
    """Those somebody may read: ground truth first, the many of the workers last."""
    rank = Case(
        When(kind=Layer.Kind.GROUND_TRUTH, then=Value(0)),
        When(kind=Layer.Kind.ASSIGNMENT, then=Value(2)),
        default=Value(1),
    )
    return layers_of(user).filter(dataset=dataset).select_related("dataset").order_by(rank, "name")


class LayerChoice:
    """The layers a page offers and the ones its address names; two queries."""

    def __init__(self, dataset: Dataset, user: Somebody, *names: str | None) -> None:
        found = layers_by_importance(dataset, user)
        self.listed = list(found[:LAYERS_SHOWN])
        asked = [name for name in names if name]
        self._by_name = {layer.name: layer for layer in self.listed}
        missing = [name for name in asked if name not in self._by_name]
        for layer in found.filter(name__in=missing) if missing else []:
            self._by_name[layer.name] = layer

    def get(self, name: str | None) -> Layer | None:
        return self._by_name.get(name or "")

    @property
    def choices(self) -> list[tuple[str, str]]:
        return [(name, name) for name in self._by_name]
