"""Who stands where in one frame of one layer: rules, saves, revisions."""
