"""Start, record and score closed-loop runs, with ROS 2 or without."""
