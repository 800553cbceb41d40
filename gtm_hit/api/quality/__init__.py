"""Comparison, agreement, evaluation, statistics."""
