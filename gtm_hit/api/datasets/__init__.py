"""Datasets, their frames, layers and imports."""
