"""The verdict over a run: its state, and its criteria beside the limits that can be cited."""
