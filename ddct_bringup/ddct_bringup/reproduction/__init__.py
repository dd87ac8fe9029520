"""Reproduction of the thesis: its numbers, figures, studies and calibration."""
