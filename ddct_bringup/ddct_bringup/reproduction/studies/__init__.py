"""Tables of closed-loop runs that show what decides how the predictive controllers fare."""
