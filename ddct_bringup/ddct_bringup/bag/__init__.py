"""Recordings of runs as rosbag2 bags: write, read, check and repair them."""
