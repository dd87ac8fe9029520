"""What is kept of the thesis: Table 5.1 as printed, and what the admissible scenarios predict."""
