# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Base of every node: settings, run information, subscriptions, and the end of the node."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any, ClassVar

from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.task import Future

from ddct_plant.bag_file.cdr import stamp_of_cdr
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.options import require_known
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.graph.node_names import topic_in_graph
from ddct_plant.graph.node_reports import ABOUT, CASE, KNOWN, TWO_INPUT, run_info_pairs
from ddct_plant.graph.output import Output
from ddct_plant.graph.qos import (
    LOOP_QOS,
    QOS_OVERRIDES,
    RECORDER_LATCHED_QOS,
    named_override_errors,
    overriding_options,
    own_copy,
)
from ddct_plant.graph.rare_warnings import RareWarnings
from ddct_plant.graph.settings import (
    UndeclaredParameterError,
    as_declared,
    declare_case,
    declare_known,
    full_name,
    has_files,
)
from ddct_plant.graph.steady_time import Cancellable, SteadyTime
from ddct_plant.graph.wire import decoder
from ddct_plant.scenario.recorded_settings import (
    known_values,
    require_agreement,
    require_same,
    values_of,
)
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import RUN_INFO, RUN_SETTINGS
from ddct_plant.ticks.reply_limit import ReplyLimit

_FOREIGN = ('use_sim_time', 'start_type_description_service', QOS_OVERRIDES)
"""Prefixes of the parameters that rclpy declares itself."""


class GraphNode(Node):
    """
    Base node: it has the settings of the run, and publishes on `run_info` what it is.

    A node that was started by hand, with parameters in place of files, compares its settings with
    those that the recorder publishes.

    Not a lifecycle node: nothing in this project would drive the transitions.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = ()
    """Arguments after `--ros-args` that `--help` shows as examples for this node."""
    DEFAULTS: ClassVar[Mapping[str, Any]] = {}
    """Defaults of shared parameters that differ from those of other nodes, by name."""
    KNOWN_ONLY: ClassVar[bool] = False
    """Whether the node controls: it has the known settings of the run, and no others."""

    def __init__(self, name: str, *, steady_time: SteadyTime | None = None, **kwargs: Any) -> None:
        """Declare the shared parameters; raise ParameterError when one cannot be used."""
        try:
            super().__init__(name, **kwargs)
        except RuntimeError as error:  # so rcl refuses security that the middleware lacks
            reason = ' '.join(str(error).split(', at /')[0].split())
            raise DdctError(f'{reason}: mend the environment variables ROS_*') from error
        self._kind = name
        self.steady_time = steady_time or SteadyTime()
        """Time by which the node waits."""
        self.known = declare_known(self, self.DEFAULTS)
        """Settings of the run that every node has, and every controller knows."""
        self._true = None if self.KNOWN_ONLY else declare_case(self, self.known, self.DEFAULTS)
        self.add_pre_set_parameters_callback(self._as_declared)
        self._warnings = RareWarnings(self, self.steady_time.monotonic)
        self.limit: ReplyLimit | None = None
        """Limit of the stamps of replies in real time; None in lock-step and in the driveline."""
        self.refused = 0
        """Number of refused messages, which count as missing."""
        self.done = Future()
        """Future that is set at the end of the node, with the DdctError that ended it, or None."""
        # The same as done.done(), which takes long enough to matter for every message.
        self._over = False
        self._start = ''

    @property
    def settings(self) -> RunSettings:
        """True settings of the run; a node that controls has none."""
        assert self._true is not None, f'{self.get_name()} has the known settings alone'
        return self._true

    def publish_run_info(
        self, extra: Mapping[str, str] | None = None, *, records: bool = False
    ) -> None:
        """
        Publish what this node is, latched and stamped t_0, with `extra` entries.

        Unless it records or has the files of the run, it compares its settings with those of the
        recorder, once they come, and ends with a DdctError where they differ.
        """
        own = dict(extra or {})
        self.publish_latched(RUN_INFO, run_info_pairs(self._kind, own))
        if not records and not has_files(self):
            ours = {key: own[key] for key in (TWO_INPUT,) if key in own}
            self.subscribe_messages(RUN_SETTINGS, partial(self._compare_settings, ours))

    def publish_latched(self, topic: Topic, pairs: Mapping[str, str]) -> None:
        """Publish pairs of this node, latched and stamped t_0."""
        name = self.get_fully_qualified_name()
        Output(self, topic).fill(stamp_of_step(0), pairs.items(), name=name).publish()

    def log_start(self, *inputs: Topic, then: str = '') -> None:
        """Keep for `announce` the topics that this node waits for as ROS has them, and `then`."""
        names = ', '.join(self.resolve_topic_name(topic.name) for topic in inputs)
        self._start = f'{ABOUT[self._kind]}: waits for {names}{then}'

    def announce(self) -> None:
        """Log what this node is and waits for, if it has said so; its parameters are checked."""
        if self._start:
            self.get_logger().info(self._start)

    def _compare_settings(self, ours: Mapping[str, str], message: Any) -> None:
        """Raise DdctError where settings or other values of this node are not the recorder's."""
        _, pairs = RUN_SETTINGS.read(message)
        theirs = {key: pairs[key] for key in ours if key in pairs}
        require_agreement(full_name(self), {key: ours[key] for key in theirs}, theirs)
        if CASE in pairs and self._true is not None:
            require_same(full_name(self), values_of(self._true), pairs[CASE])
        elif KNOWN in pairs:
            require_same(full_name(self), known_values(self.known), pairs[KNOWN])

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
        values_of = read or partial(topic.read, shown=self.shown(topic.name))
        decode = decoder(topic)

        def receive(cdr: bytes) -> None:
            try:
                message = decode(cdr)
            except (DdctError, UnicodeDecodeError) as error:
                self._reject(self.shown(topic.name), error)
                return
            stamp = stamp_of_cdr(cdr)
            if not self.admits(topic.name, stamp):
                return
            try:
                values = values_of(message)
            except DdctError as error:
                self._reject(f'at stamp {stamp} ns', error)
            else:
                take(stamp, values)

        self.subscribe_messages(topic, receive, raw=True)

    def admits(self, topic: str, stamp: int) -> bool:
        """Return whether a stamp can be true; a refused message counts as missing."""
        reason = self.limit.why_refused(topic, stamp) if self.limit else ''
        if reason:
            self._refuse(reason)
        return not reason

    def shown(self, topic: str) -> str:
        """Return the name in the graph, for errors, of what this node calls `topic`."""
        return topic_in_graph(topic, self.get_namespace())

    def _reject(self, where: str, error: Exception) -> None:
        """Raise an error about a bad message in lock-step; in real time the message is missing."""
        reason = f'{where}: {error}'
        if self.known.lockstep:
            raise DdctError(reason) from error
        self._refuse(reason)

    def _refuse(self, reason: str) -> None:
        self.refused += 1
        self._warnings.warn(f'{reason} (counts as missing; {self.refused} so far)')

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
        with named_override_errors(self.shown(topic.name)):
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

    def require_parameters(self, names: Iterable[str]) -> None:
        """Raise ParameterError for a name that the node does not declare, with the known ones."""
        own = self.own_parameters()
        for name in names:
            if not self.has_parameter(name):
                group, dot, _ = name.rpartition('.')
                alike = [each for each in own if each.startswith(f'{group}{dot}')]
                require_known([name], alike or own, 'parameter')

    def _as_declared(self, given: list[Parameter]) -> list[Parameter]:
        """Return parameters that are set in the run, whole numbers in the types declared."""
        try:
            self.require_parameters(each.name for each in given)
        except ParameterError as error:
            raise UndeclaredParameterError(error) from error
        types = [Parameter.Type(self.describe_parameter(each.name).type) for each in given]
        return [as_declared(*each) for each in zip(given, types, strict=True)]

    def undeclared_parameters(self) -> list[str]:
        """Return the names of the given parameters that neither node nor rclpy declares."""
        given = self._parameter_overrides
        return [name for name in given if not self.has_parameter(name)]

    def every(self, period_s: float, callback: Callable[[], None]) -> Cancellable:
        """Call `callback` every `period_s` of the steady time; a DdctError in it ends the node."""
        return self.steady_time.every(self, period_s, self.guarded(callback))

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
