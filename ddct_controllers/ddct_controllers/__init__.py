"""Clutch controllers, their interface and their registry."""
