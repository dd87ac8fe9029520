"""Controllers after the works that the thesis cites as the state of the art (Section 1.3)."""
