"""Long work: rows that are queued, claimed, reported on and finished."""
