"""The graph's nodes as processes, or all in one: started, watched, and none left behind."""
