"""The thesis's figures that can be computed, by number, and the gallery that shows them."""
