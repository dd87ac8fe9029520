"""Closed-loop runs of the thesis's scenario, and which of them it shows together."""
