"""Fail-safe of a real-time run whose requests or torques stop; no ROS."""
