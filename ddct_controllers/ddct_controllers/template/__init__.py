"""Template of a package for a controller of one's own, as `new-controller` writes it."""
