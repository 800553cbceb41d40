"""Named proofs that a worker can do it: made, tried, granted, revoked, asked for."""
