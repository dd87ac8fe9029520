"""What is computed for the numbers of Chapters 1 to 4."""
