"""Time stepping: the owner of time, the join of inputs and the limits of stamps; no ROS."""
