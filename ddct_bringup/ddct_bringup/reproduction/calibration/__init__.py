"""Fit of the scenario to rows of the thesis's Table 5.1."""
