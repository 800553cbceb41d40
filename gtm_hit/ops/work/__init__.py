"""Who works on what: workers, links, batches, assignments."""
