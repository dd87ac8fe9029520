"""Figures of the thesis that can be computed, by number, and the gallery that shows them."""
