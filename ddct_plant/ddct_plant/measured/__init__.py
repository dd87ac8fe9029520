"""Logs of other tools and recorded bags: quantities by name, in SI units."""
