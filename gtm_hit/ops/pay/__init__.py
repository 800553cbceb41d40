"""Time and pay: active seconds as the server can believe them, and a ledger that only grows."""
