"""Analysis of sampled loops: margins, corners of plant and wear, step responses."""
