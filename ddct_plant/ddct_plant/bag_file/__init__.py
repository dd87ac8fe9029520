# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Bytes of a bag: MCAP records, CDR, rosbag2's metadata and message definitions."""
