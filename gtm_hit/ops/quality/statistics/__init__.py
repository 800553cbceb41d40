"""What a paper prints about a layer: numbers, figures, tables."""
