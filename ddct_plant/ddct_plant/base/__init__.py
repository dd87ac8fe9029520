"""Errors, checks, options, units and the time base: the foundation of all packages."""
