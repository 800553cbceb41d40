"""Videos of several cameras into frames: which picture of each belongs to which instant, and the import."""
