"""Bytes of a bag: MCAP records, CDR, rosbag2's metadata and message definitions."""
