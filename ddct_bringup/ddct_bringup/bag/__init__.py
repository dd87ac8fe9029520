"""Recordings: writing, reading, checking and repairing bags."""
