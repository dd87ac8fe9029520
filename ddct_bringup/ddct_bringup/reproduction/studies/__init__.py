"""Tables of closed-loop runs on the causes of the predictive controllers' results."""
