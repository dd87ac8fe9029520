"""Every number that the thesis prints, beside what this repository computes for it."""
