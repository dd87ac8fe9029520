"""One run: its plan, the graph or the headless loop that carries it out, and its folder."""
