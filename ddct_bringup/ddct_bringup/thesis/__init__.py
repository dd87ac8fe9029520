"""Data of the thesis: Table 5.1 as printed, and predictions of the admissible scenarios."""
