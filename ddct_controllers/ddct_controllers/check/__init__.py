"""Conformance check of a controller: the trials and checks of `check-controller`."""
