"""Layers go out as files of many formats."""
