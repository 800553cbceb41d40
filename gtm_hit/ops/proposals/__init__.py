"""People whom programs propose: found by jobs, shown to annotators, never an annotation by themselves."""
