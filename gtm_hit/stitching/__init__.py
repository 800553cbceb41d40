"""Many small batches into one layer: replicas fused, neighbours joined, returners proposed.

Knows no database: people come as tracks, and what is decided goes back as chains of tracks and doubts.
"""
