"""Files of people: one module a format."""
