"""Putting the clocks of several videos together: drafts, the first guess, and their pictures."""
