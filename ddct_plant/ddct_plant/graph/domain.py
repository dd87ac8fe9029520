"""What a graph needs of ROS: its packages, and a domain; checked before any node starts."""

import importlib.util
import os

from ddct_plant.base.errors import DdctError

LAST_DOMAIN = 232
"""Beyond it DDS has no ports, and its middleware ends the process without a word."""


def require_ros() -> None:
    """Raise DdctError where ROS is not installed, which headless runs and scores do without."""
    if importlib.util.find_spec('rclpy') is None:
        raise DdctError(
            'the graph and its nodes need ROS 2, and its package rclpy is not installed: run '
            'headless, or set ROS up as docs/use/setup.md tells'
        )


def require_domain() -> int | None:
    """Return ROS_DOMAIN_ID, None when it is not set; raise DdctError unless it is a domain."""
    text = os.environ.get('ROS_DOMAIN_ID')
    if not text:
        return None
    if not text.isdecimal() or int(text) > LAST_DOMAIN:
        raise DdctError(f'ROS_DOMAIN_ID is {text!r}: give a whole number from 0 to {LAST_DOMAIN}')
    return int(text)
