"""Annotations of other programs into a layer: read → list what does not fit → place → write, or nothing."""
