"""What a node tells in real time of messages that it refused, and of its safe state."""

from rclpy.node import Node

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import STEPS_PER_S
from ddct_plant.graph.node import GraphNode, Output
from ddct_plant.graph.topics import DIAGNOSTICS, SAFE_STATE, SINCE
from ddct_plant.ticks.stamp_limit import StampLimit


class Refusals:
    """Count messages that count as missing in real time, as nothing in them can be relied on."""

    def __init__(self, node: GraphNode, limit: StampLimit | None = None) -> None:
        """Refuse for `node` what the limit of stamps says, if there is one."""
        self._node = node
        self._limit = limit
        self.count = 0

    def admits(self, topic: str, stamp: int) -> bool:
        """Say whether a stamp may be true; count and tell where it may not."""
        reason = self._limit.why_refused(topic, stamp) if self._limit else ''
        if reason:
            self._add(reason)
        return not reason

    def bad_values(self, stamp: int, error: DdctError) -> None:
        """Refuse a message for its values; raise DdctError in lock-step."""
        reason = f'at stamp {stamp} ns: {error}'
        if self._node.settings.lockstep:
            raise DdctError(reason) from error
        self._add(reason)

    def _add(self, reason: str) -> None:
        self.count += 1
        self._node.get_logger().warning(
            f'{reason} (counts as missing; {self.count} so far)',
            throttle_duration_sec=1.0,
            throttle_time_source_type=self._node.get_clock(),
        )


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
