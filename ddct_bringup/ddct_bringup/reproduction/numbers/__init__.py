"""The gate: every number and claim of the thesis beside what is computed."""
