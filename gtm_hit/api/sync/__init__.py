"""Putting the clocks of videos together."""
