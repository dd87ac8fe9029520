"""Recorder: the node that writes the topics of the graph into a bag."""
