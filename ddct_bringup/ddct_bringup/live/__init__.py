"""Live view of the graph in Foxglove: a WebSocket server and the node that feeds it."""
