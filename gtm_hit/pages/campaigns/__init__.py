"""Campaigns as their managers see them."""
