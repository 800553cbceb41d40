"""How good layers are and what they hold, measured by `gtm_hit.metrics` on rows of the database."""
