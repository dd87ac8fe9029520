"""The thesis reproduced: its numbers, figures, studies and calibration."""
