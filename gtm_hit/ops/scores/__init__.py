"""How good workers and their assignments are, as numbers, with reasons in words."""
