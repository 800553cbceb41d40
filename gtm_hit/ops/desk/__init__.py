"""Calibrations being made: drafts, clicks, solves, and putting them in place."""
