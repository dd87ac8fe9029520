"""Model predictive controllers of the clutch."""
