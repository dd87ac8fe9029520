"""What a node tells in real time of its safe state."""

from rclpy.node import Node

from ddct_plant.base.timebase import STEPS_PER_S
from ddct_plant.graph.node import Output
from ddct_plant.graph.topics import DIAGNOSTICS, SAFE_STATE, SINCE


class SafeStateReport:
    """Say once why, and from then on every second since when: who comes late hears it too."""

    def __init__(self, node: Node) -> None:
        """Publish on `/diagnostics` for `node`; real time only, so lock-step bags hold none."""
        self._node = node
        self._output = Output(node, DIAGNOSTICS)
        self._since: int | None = None

    def tell(self, step: int, stamp: int, why: str) -> None:
        """Tell at the tick of a step in the safe state, which the first call begins."""
        if self._since is None:
            self._since = stamp
            self._node.get_logger().error(f'safe state from stamp {stamp} ns on: {why}')
        elif step % STEPS_PER_S:
            return
        pairs = ((SINCE, str(self._since)), ('why', why))
        name = f'{self._node.get_name()}{SAFE_STATE}'
        self._output.fill(stamp, pairs, name=name, error=why).publish()
