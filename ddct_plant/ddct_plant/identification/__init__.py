"""Identification of driveline parameters, from printed transfer functions or a log."""
