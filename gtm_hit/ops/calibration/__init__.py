"""Another calibration for a dataset: read, compared box by box with the one it has, then put in its place."""
