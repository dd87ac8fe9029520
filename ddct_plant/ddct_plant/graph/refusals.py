"""Messages that count as missing in real time, because nothing in them can be relied on."""

from rclpy.node import Node


class Refusals:
    """Count refused messages and say why, at most once a second."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self.count = 0

    def add(self, reason: str) -> None:
        """Take one more message that was refused for `reason`."""
        self.count += 1
        self._node.get_logger().warning(
            f'{reason} (counts as missing; {self.count} so far)',
            throttle_duration_sec=1.0,
            throttle_time_source_type=self._node.get_clock(),
        )
