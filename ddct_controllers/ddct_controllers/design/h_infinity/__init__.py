"""H-infinity synthesis (Chapter 3): weights, problem, Riccati and LMI solutions, cleaning."""
