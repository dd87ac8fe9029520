"""What a run in real time does when requests or torques stop; no ROS."""
