"""What all REST endpoints share: who asks, how bodies are read, how refusals read."""
