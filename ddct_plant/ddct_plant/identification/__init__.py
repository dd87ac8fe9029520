"""The driveline parameters behind the thesis's printed transfer functions."""
