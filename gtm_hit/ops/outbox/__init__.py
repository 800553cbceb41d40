"""What is told to platforms: planned as rows, sent once, reconciled when an answer was lost."""
