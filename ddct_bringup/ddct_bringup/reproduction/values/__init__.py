"""Computed values for the numbers of the thesis."""
