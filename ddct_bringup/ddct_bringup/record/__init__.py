"""The recorder: the node that takes the topics off the wire into a bag."""
