"""Sampled loops: margins, corners of plant and wear, step responses."""
