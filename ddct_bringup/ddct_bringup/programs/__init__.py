"""Programs of this package, one per module."""
