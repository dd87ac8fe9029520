"""Scenarios: what a run consists of, read from files, with its initial state."""
