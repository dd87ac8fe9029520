"""From cost, horizon and limits to a quadratic program, and to what it holds at each step."""
