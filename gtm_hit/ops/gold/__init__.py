"""Known truth and planted faults inside ordinary work."""
