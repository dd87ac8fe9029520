"""Thesis gate: comparison of every number and claim of the thesis with a computed one."""
