"""What a release holds beyond an export: who made what, what changed, how good it is."""
