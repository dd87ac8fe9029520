"""The quadratic program of cost, horizon and limits, and its data at each step."""
