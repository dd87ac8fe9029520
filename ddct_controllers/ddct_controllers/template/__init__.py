"""A package for a controller of one's own: what `new-controller` writes."""
