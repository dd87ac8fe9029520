"""The plant's ROS 2 nodes: thin shells around the models."""
