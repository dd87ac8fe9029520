"""Who steps when: the owner of time, its barrier, the join and the limits of stamps; no ROS."""
