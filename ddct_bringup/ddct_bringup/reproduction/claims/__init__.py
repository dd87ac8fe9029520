"""What is computed for Chapter 5 and for claims in words, from closed-loop runs."""
