"""Comparison, statistics, evaluation of text files."""
