"""Processes of the graph's nodes, one each or all in one: start, supervise and stop them."""
