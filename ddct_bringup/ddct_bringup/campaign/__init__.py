"""Campaigns of many headless runs: specification, rows of results, and worker processes."""
