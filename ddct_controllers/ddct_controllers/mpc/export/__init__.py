"""Predictive controllers as C for a control unit (thesis Section 6.1)."""
