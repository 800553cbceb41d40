"""Whether a camera still stands as it was calibrated: marks of its picture, found again in later ones."""
