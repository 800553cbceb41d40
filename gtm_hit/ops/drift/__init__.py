"""Whether a dataset's cameras still stand as they did when they were calibrated."""
