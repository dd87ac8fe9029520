"""The generalised plant, the Riccati and LMI solutions, and the norm that accepts them."""
