"""The running graph in Foxglove: a WebSocket server and the node that feeds it."""
