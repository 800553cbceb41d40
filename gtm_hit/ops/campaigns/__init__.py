"""Campaigns: rules, states, who may come in, links, and how it goes."""
