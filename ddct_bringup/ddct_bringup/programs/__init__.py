"""The programs of this package, one a module."""
