"""Base of every node: settings, run information, what it takes in, and how it ends."""

from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.task import Future
from rclpy.timer import Timer

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import STEPS_PER_S, stamp_of_step
from ddct_plant.graph.message_kinds import stamp_ns
from ddct_plant.graph.qos import LATCHED_QOS, LOOP_QOS, RECORDER_LATCHED_QOS
from ddct_plant.graph.run_info import run_info_pairs
from ddct_plant.graph.settings import declare_settings
from ddct_plant.graph.topics import DIAGNOSTICS, RUN_INFO, SAFE_STATE, SINCE, Topic
from ddct_plant.ticks.stamp_limit import StampLimit

STEADY = Clock(clock_type=ClockType.STEADY_TIME)
"""What every timer goes by: on a ROS clock it would wait for simulated time."""

_FOREIGN = ('use_sim_time', 'start_type_description_service', 'qos_overrides')
"""Parameters that rclpy declares itself begin with one of these."""


class Output:
    """The publisher of a topic, with the one message that it sends again and again."""

    def __init__(self, node: Node, topic: Topic) -> None:
        qos = LATCHED_QOS if topic.latched else LOOP_QOS
        self._publisher = node.create_publisher(topic.message_class, topic.name, qos)
        self._write = topic.writer()
        self._message: Any = None

    def fill(self, stamp: int, *values: Any, **options: Any) -> 'Output':
        """Put a stamp in ns and the topic's values into the message; return itself."""
        self._message = self._write(stamp, *values, **options)
        return self

    def publish(self) -> None:
        """Send the message as it was filled last."""
        self._publisher.publish(self._message)


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


class GraphNode(Node):
    """
    A plain node that shares the run's settings and says so on `run_info`.

    Not a lifecycle node: nothing in this project would drive the transitions.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = ()
    """What `--help` shows behind `--ros-args`; what makes sense for this node alone."""

    def __init__(self, name: str, **kwargs: Any) -> None:
        """Declare the shared parameters; raise ParameterError when one cannot be used."""
        super().__init__(name, **kwargs)
        self.settings = declare_settings(self)
        self.limit: StampLimit | None = None
        """In real time: which stamps may be true."""
        self.refused = 0
        """Messages that counted as missing, as nothing in them can be relied on."""
        self.done = Future()
        """Set when the node has nothing more to do, with the DdctError that ended it, or None."""
        # The same as done.done(), which takes long enough to matter for every message.
        self._over = False

    def publish_run_info(self, extra: Mapping[str, str] | None = None) -> None:
        """Latch this node's settings, stamped t_0."""
        pairs = run_info_pairs(self.settings, extra)
        Output(self, RUN_INFO).fill(stamp_of_step(0), pairs, name=self.get_name()).publish()

    def hear(
        self,
        topic: Topic,
        take: Callable[[int, Any], None],
        read: Callable[[Any], Any] | None = None,
    ) -> None:
        """
        Call `take(stamp, values)` with every message of a topic that can be relied on.

        Its values are read as the topic says, or by `read`, which raises DdctError for bad ones.
        In lock-step they end the node; in real time they count as missing.
        """
        values_of = read or topic.read

        def receive(message: Any) -> None:
            stamp = stamp_ns(message)
            if not self.admits(topic.name, stamp):
                return
            try:
                values = values_of(message)
            except DdctError as error:
                reason = f'at stamp {stamp} ns: {error}'
                if self.settings.lockstep:
                    raise DdctError(reason) from error
                self._refuse(reason)
            else:
                take(stamp, values)

        self.listen(topic, receive)

    def admits(self, topic: str, stamp: int) -> bool:
        """Say whether a stamp may be true; a message that is refused counts as missing."""
        reason = self.limit.why_refused(topic, stamp) if self.limit else ''
        if reason:
            self._refuse(reason)
        return not reason

    def _refuse(self, reason: str) -> None:
        self.refused += 1
        self.get_logger().warning(
            f'{reason} (counts as missing; {self.refused} so far)',
            throttle_duration_sec=1.0,
            throttle_time_source_type=self.get_clock(),
        )

    def listen(
        self,
        topic: Topic,
        receive: Callable[[Any], None],
        qos: QoSProfile = LOOP_QOS,
        *,
        raw: bool = False,
    ) -> None:
        """
        Call `receive` with each message of a topic, or its bytes; a DdctError ends the node.

        `qos` is for topics that are not latched.
        """
        guarded = self.guarded(receive)
        qos = RECORDER_LATCHED_QOS if topic.latched else qos
        self.create_subscription(topic.message_class, topic.name, guarded, qos, raw=raw)

    def own_parameters(self) -> list[str]:
        """Return the names of the parameters that the node itself declares."""
        names = self.list_parameters([], 0).names
        return [name for name in names if not name.startswith(_FOREIGN)]

    def undeclared_parameters(self) -> list[str]:
        """Return the names of the parameters that it was given and does not declare."""
        given = self._parameter_overrides
        return [
            name
            for name in given
            if not self.has_parameter(name) and not name.startswith(_FOREIGN)
        ]

    def every(self, period_s: float, callback: Callable[[], None]) -> Timer:
        """Call `callback` again and again, by a steady clock; a DdctError ends the node."""
        return self.create_timer(period_s, self.guarded(callback), clock=STEADY)

    def guarded(self, callback: Callable[..., None]) -> Callable[..., None]:
        """Wrap a callback so that a DdctError ends the node with its one-line reason."""

        def call(*arguments: Any) -> None:
            if self._over:
                return
            try:
                callback(*arguments)
            except DdctError as error:
                self.finish(error)

        return call

    def finish(self, error: DdctError | None = None) -> None:
        """End the node, with the error that made it end or None when its work is done."""
        if not self._over:
            self._over = True
            self.done.set_result(error)

    def close(self) -> None:
        """Flush what the node still holds; called once, before it is destroyed."""
