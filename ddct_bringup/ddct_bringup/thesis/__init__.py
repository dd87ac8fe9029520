"""Numbers and figures of the thesis that need a closed loop."""
