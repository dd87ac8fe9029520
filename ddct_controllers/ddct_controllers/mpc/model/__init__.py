"""Models of the transmission that predictive controllers and their observers share."""
