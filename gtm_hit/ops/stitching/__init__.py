"""Accepted batches into one ground-truth layer, again and again, changing only what changed."""
