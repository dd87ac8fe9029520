"""Simulation of many runs of linear plants and controllers at once, one array column per run."""
