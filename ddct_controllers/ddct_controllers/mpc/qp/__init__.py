"""Quadratic programs of the predictive controllers, behind one small backend interface."""
