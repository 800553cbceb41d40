"""Datasets: list, overview, imports."""
