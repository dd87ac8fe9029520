"""Estimators: states that are not measured, disturbances, wear."""
