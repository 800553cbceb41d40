"""Layers of a dataset: list, export, import."""
