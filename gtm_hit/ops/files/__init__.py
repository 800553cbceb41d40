"""Bytes that come in and stay: sources of imports, pictures by their digest."""
