"""The ground grid of a dataset: its table of rectangles and what the cameras see of it."""
