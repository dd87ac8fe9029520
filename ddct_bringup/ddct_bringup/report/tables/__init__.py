"""The tables of the page, and where the runs come from."""
