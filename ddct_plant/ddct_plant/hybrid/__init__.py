"""Linear systems with dry friction that sticks, integrated exactly; no ROS, no clock."""
