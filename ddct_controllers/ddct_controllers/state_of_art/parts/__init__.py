"""Parts that several controllers of the state of the art share."""
