"""Batches for managers, and the workers' own pages."""
