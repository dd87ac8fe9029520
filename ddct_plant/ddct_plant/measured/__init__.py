"""Logs that other tools or our bags hold: columns by name, in SI units."""
