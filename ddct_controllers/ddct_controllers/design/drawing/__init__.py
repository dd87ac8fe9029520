"""Charts of designs and loops."""
