"""Calibration desks."""
