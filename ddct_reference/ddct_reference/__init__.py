"""Slip-speed references for the clutch."""
