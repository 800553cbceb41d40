"""Layers as the command line names them."""

from __future__ import annotations

from django.core.management.base import CommandError

from gtm_hit.models import Layer


def layer_named(slug: str, name: str) -> Layer:
    """With its dataset; raises CommandError that tells which layers there are."""
    found = Layer.objects.select_related("dataset").filter(dataset__slug=slug, name=name).first()
    if found is None:
        names = ", ".join(Layer.objects.filter(dataset__slug=slug).values_list("name", flat=True))
        raise CommandError(f"no layer {name} in dataset {slug}; there are: {names or 'none'}")
    return found
