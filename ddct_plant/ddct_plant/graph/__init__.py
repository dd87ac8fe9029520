"""ROS 2 plumbing that every node of the project shares."""
