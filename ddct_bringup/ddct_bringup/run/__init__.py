"""One run: its plan, the graph or headless loop that executes it, and its output folder."""
