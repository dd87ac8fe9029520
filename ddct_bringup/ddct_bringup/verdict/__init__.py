"""Verdict of a run: its state, and its criteria compared with limits whose source is cited."""
