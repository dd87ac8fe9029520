"""Scores computed from a recording, and the tables that show them."""
