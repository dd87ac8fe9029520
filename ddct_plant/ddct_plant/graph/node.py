# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Base of every node: settings, run information, subscriptions, and the end of the node."""

from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.task import Future
from rclpy.timer import Timer

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import STEPS_PER_S, stamp_of_step
from ddct_plant.graph.node_names import StatusName
from ddct_plant.graph.node_reports import SAFE_STATE, run_info_pairs, safe_state_pairs
from ddct_plant.graph.qos import (
    LATCHED_QOS,
    LOOP_QOS,
    QOS_OVERRIDES,
    RECORDER_LATCHED_QOS,
    named_override_errors,
    overriding_options,
    own_copy,
)
from ddct_plant.graph.settings import declare_settings
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    DIAGNOSTICS,
    RUN_INFO,
)
from ddct_plant.ticks.stamp_limit import StampLimit

STEADY = Clock(clock_type=ClockType.STEADY_TIME)
"""Clock of every timer: a ROS clock would wait for simulated time."""

_FOREIGN = ('use_sim_time', 'start_type_description_service', QOS_OVERRIDES)
"""Prefixes of the parameters that rclpy declares itself."""


def create_publisher(node: Node, topic: Topic) -> Publisher:
    """Return a publisher of a topic; raise ParameterError for an unusable override of its QoS."""
    qos = LATCHED_QOS if topic.latched else LOOP_QOS
    with named_override_errors(topic.name):
        return node.create_publisher(
            topic.message_class,
            topic.name,
            own_copy(qos),
            qos_overriding_options=overriding_options(qos),
        )


class Output:
    """Publisher of a topic, with one message that is filled anew for every tick."""

    def __init__(self, node: Node, topic: Topic) -> None:
        self._publisher = create_publisher(node, topic)
        self._write = topic.writer()
        self._message: Any = None

    def fill(self, stamp: int, *values: Any, **options: Any) -> 'Output':
        """Fill the message with a stamp in ns and the topic's values; return this output."""
        self._message = self._write(stamp, *values, **options)
        return self

    def publish(self) -> None:
        """Publish the message with the values of the last `fill`."""
        self._publisher.publish(self._message)


class SafeStateReport:
    """Report of a safe state: logged once, published at once and then every second."""

    def __init__(self, node: Node) -> None:
        """Publish on `/diagnostics` for `node`; in real time only, so lock-step bags have none."""
        self._node = node
        self._output = Output(node, DIAGNOSTICS)
        self._since: int | None = None

    def publish(self, step: int, stamp: int, why: str) -> None:
        """Publish the report if it is due at this tick; the first call begins the safe state."""
        if self._since is None:
            self._since = stamp
            self._node.get_logger().error(f'safe state from stamp {stamp} ns on: {why}')
        elif step % STEPS_PER_S:
            return
        pairs = safe_state_pairs(self._since, why)
        name = StatusName(self._node.get_fully_qualified_name(), SAFE_STATE)
        self._output.fill(stamp, pairs, name=str(name), error=why).publish()


class GraphNode(Node):
    """
    Base node: it declares the settings of the run and publishes them on `run_info`.

    Not a lifecycle node: nothing in this project would drive the transitions.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = ()
    """Arguments after `--ros-args` that `--help` shows as examples for this node."""

    def __init__(self, name: str, **kwargs: Any) -> None:
        """Declare the shared parameters; raise ParameterError when one cannot be used."""
        super().__init__(name, **kwargs)
        self.settings = declare_settings(self)
        self.limit: StampLimit | None = None
        """Limit of plausible stamps in real time; None in lock-step."""
        self.refused = 0
        """Number of refused messages, which count as missing."""
        self.done = Future()
        """Future that is set at the end of the node, with the DdctError that ended it, or None."""
        # The same as done.done(), which takes long enough to matter for every message.
        self._over = False

    def publish_run_info(self, extra: Mapping[str, str] | None = None) -> None:
        """Publish this node's settings, latched and stamped t_0, with `extra` entries."""
        pairs = run_info_pairs(self.settings, extra)
        name = self.get_fully_qualified_name()
        Output(self, RUN_INFO).fill(stamp_of_step(0), pairs.items(), name=name).publish()

    def subscribe_values(
        self,
        topic: Topic,
        take: Callable[[int, Any], None],
        read: Callable[[Any], Any] | None = None,
    ) -> None:
        """
        Subscribe to a topic; call `take(stamp, values)` with each message that passes its checks.

        Values are read by `Topic.read`, or by `read`, which raises DdctError for bad ones. In
        lock-step a bad message ends the node; in real time it counts as missing.
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

        self.subscribe_messages(topic, receive)

    def admits(self, topic: str, stamp: int) -> bool:
        """Return whether a stamp is plausible; a refused message counts as missing."""
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

    def subscribe_messages(
        self,
        topic: Topic,
        receive: Callable[[Any], None],
        qos: QoSProfile = LOOP_QOS,
        *,
        raw: bool = False,
    ) -> None:
        """
        Subscribe to a topic; call `receive` with each message, or with its bytes if `raw`.

        A DdctError in `receive` ends the node. `qos` is for topics that are not latched. Raise
        ParameterError for an unusable override of it.
        """
        guarded = self.guarded(receive)
        qos = RECORDER_LATCHED_QOS if topic.latched else qos
        with named_override_errors(topic.name):
            self.create_subscription(
                topic.message_class,
                topic.name,
                guarded,
                own_copy(qos),
                raw=raw,
                qos_overriding_options=overriding_options(qos),
            )

    def own_parameters(self) -> list[str]:
        """Return the names of the parameters that the node itself declares."""
        names = self.list_parameters([], 0).names
        return [name for name in names if not name.startswith(_FOREIGN)]

    def undeclared_parameters(self) -> list[str]:
        """Return the names of the given parameters that neither node nor rclpy declares."""
        given = self._parameter_overrides
        return [name for name in given if not self.has_parameter(name)]

    def every(self, period_s: float, callback: Callable[[], None]) -> Timer:
        """Call `callback` every `period_s` of a steady clock; a DdctError in it ends the node."""
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
        """Flush buffered output; called once, before the node is destroyed."""
