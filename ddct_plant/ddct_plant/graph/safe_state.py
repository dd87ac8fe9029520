"""How a node tells that it has gone to its safe state, in its log and on `/diagnostics`."""

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node

from ddct_plant.base.timebase import STEPS_PER_S
from ddct_plant.graph.message_values import SAFE_STATE, SINCE
from ddct_plant.graph.messages import status_message
from ddct_plant.graph.qos import LOOP_QOS


class SafeStateReport:
    """Say once why, and from then on every second since when: who comes late hears it too."""

    def __init__(self, node: Node) -> None:
        """Publish on `/diagnostics` for `node`; real time only, so lock-step bags hold none."""
        self._node = node
        self._publisher = node.create_publisher(DiagnosticArray, '/diagnostics', LOOP_QOS)
        self._since: int | None = None

    def tell(self, step: int, stamp: int, why: str) -> None:
        """Tell at the tick of a step in the safe state, which the first call begins."""
        if self._since is None:
            self._since = stamp
            self._node.get_logger().error(f'safe state from stamp {stamp} ns on: {why}')
        elif step % STEPS_PER_S:
            return
        pairs = ((SINCE, str(self._since)), ('why', why))
        message = status_message(stamp, f'{self._node.get_name()}{SAFE_STATE}', pairs)
        message.status[0].level = DiagnosticStatus.ERROR
        message.status[0].message = why
        self._publisher.publish(message)
