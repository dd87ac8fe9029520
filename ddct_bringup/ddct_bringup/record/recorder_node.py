# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node `recorder`: writes every tick into a bag and acknowledges it."""

import math
from functools import partial
from typing import Any, ClassVar

from rclpy.serialization import deserialize_message, serialize_message

from ddct_bringup.bag.run_info import RUN_INFO_TOPICS
from ddct_bringup.record.parameters import declare_parameters
from ddct_bringup.record.recorded_bag import RecordedBag
from ddct_bringup.record.run_info_collector import RunInfoCollector
from ddct_bringup.record.tick_buffer import TickBuffer, TwoMessagesError
from ddct_bringup.record.wall_clock_facts import WallClockFacts
from ddct_plant.bag_file.cdr import CdrNormaliser, stamp_of_cdr
from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.node_names import StatusName, name_in_graph
from ddct_plant.graph.node_reports import CASE, KNOWN, TWO_INPUT, flag, update_times
from ddct_plant.graph.output import create_publisher
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.graph.settings import has_files
from ddct_plant.graph.sole_publishers import publishers_of
from ddct_plant.graph.spin import run_node
from ddct_plant.graph.wire import serialiser
from ddct_plant.scenario.recorded_settings import known_values, values_of, values_text
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    CONTROLLER_TIMING,
    DIAGNOSTICS,
    JOINT_STATES,
    OFF_GOING_RUN_SETTINGS,
    RECORDER_ACK,
    RUN_INFO,
    RUN_SETTINGS,
    TOPICS,
    TORQUE_PARTS,
    recorded_topics,
    tick_names,
)
from ddct_plant.ticks.reply_limit import ReplyLimit

REPEATED_UNTIL_ACK = JOINT_STATES
"""Topic that is repeated until the acknowledgement arrives; a repetition means one was lost."""
PATIENCE_S = 5.0
"""Wall time without a node's `run_info` before a warning names it, s."""


class RecorderNode(GraphNode):
    """
    Write a rosbag2 bag and acknowledge each complete tick on `recorder/ack`.

    The bag is opened once every node has published its `run_info` and t_0 is complete. In
    lock-step the bag is deterministic; wall-clock times go to `timing.json`.
    """

    EXAMPLES: ClassVar[tuple[str, ...]] = ('-p out:=runs/mine',)

    def __init__(self, **kwargs: Any) -> None:
        """Declare the parameters and subscribe to every recorded topic."""
        super().__init__('recorder', **kwargs)
        recording = self._recording = declare_parameters(self)
        self._nodes = RunInfoCollector(recording.nodes)
        self._run = self.known.kind(two_input=recording.two_input)
        self._topics = recorded_topics(self._run)
        ticks = [topic for topic in self._topics if topic.every_tick]
        self._buffer = TickBuffer(
            [topic.name for topic in ticks if topic is not RECORDER_ACK],
            self._same_message,
            wait_for_all=self.known.lockstep,
            certain=frozenset(topic.name for topic in ticks if topic.is_tick),
            undecided=frozenset({TORQUE_PARTS.name}),
        )
        self._bag = RecordedBag(
            (recording.folder, recording.name),
            self._run,
            self.settings,
            self._nodes,
            self._acknowledge,
        )
        if not self.known.lockstep:
            self.limit = ReplyLimit(tick_names())
        self._wall_clock = WallClockFacts()
        self._ack = create_publisher(self, RECORDER_ACK)
        self._serialise_ack = serialiser(RECORDER_ACK)
        self._acknowledged = 0
        self._second_node: DdctError | None = None
        self._subscribe_all()
        self.publish_run_info(records=True)
        nodes = ', '.join(name for name in recording.nodes if name != self.get_name())
        self.log_start(RUN_INFO, then=f' of {nodes}, then every tick, for {recording.folder}')
        self._publish_settings()
        self._patience = self.every(PATIENCE_S, self._warn_of_missing_nodes)

    def close(self) -> None:
        """
        Finish the bag and write `timing.json`.

        Warn of a run that ended early. End the node with a DdctError when nothing was recorded,
        or a second node published a topic.
        """
        try:
            self._bag.write_ticks(self._buffer.drain())
            if not self._bag.is_open:
                folder = self._recording.folder
                raise DdctError(f'{folder}: nothing was recorded, {self._waiting_for()}')
            self._bag.close()
            self._warn_of_early_end()
            self._wall_clock.write(
                self._recording.folder,
                self._bag.steps,
                self._bag.wall_time_s,
                self._buffer.dropped,
                self.refused,
            )
            if self._second_node is not None:
                raise self._second_node
        except DdctError as error:
            self.finish(error)

    def _publish_settings(self) -> None:
        """
        Publish the settings of the run, which nodes that were started by hand compare.

        The true ones are among them only where this node was started by hand too.
        """
        pairs = {
            TWO_INPUT: flag(self._recording.two_input),
            KNOWN: values_text(known_values(self.known)),
        }
        if not has_files(self):
            pairs[CASE] = values_text(values_of(self.settings))
        self.publish_latched(RUN_SETTINGS, pairs)
        if self.known.shift:
            self.publish_latched(OFF_GOING_RUN_SETTINGS, pairs)

    def _subscribe_all(self) -> None:
        special = {
            **dict.fromkeys(RUN_INFO_TOPICS, self._on_run_info),
            CONTROLLER_TIMING: self._on_timing,
            DIAGNOSTICS: self._on_diagnostics,
        }
        for topic in TOPICS:
            if topic is RECORDER_ACK or not topic.in_run(self._run):
                continue
            usual = self._on_tick if topic.every_tick else self._bag.write_unordered
            receive = special.get(topic, partial(usual, topic))
            self.subscribe_messages(topic, receive, RECORDER_QOS, raw=True)

    def _on_tick(self, topic: Topic, cdr: bytes) -> None:
        stamp = stamp_of_cdr(cdr)
        if not self.admits(topic.name, stamp):
            return
        try:
            ready = self._buffer.offer(topic.name, stamp, cdr)
        except TwoMessagesError as error:
            publishers = publishers_of(self, topic.name)
            self._on_second_node(DdctError(f'{error}; publishers: {publishers}'))
            return
        if ready:
            self._bag.write_ticks(ready)
        elif topic is REPEATED_UNTIL_ACK and stamp == self._acknowledged:
            self._acknowledge(stamp)

    def _on_run_info(self, cdr: bytes) -> None:
        node, pairs = RUN_INFO.read(_message(RUN_INFO, cdr))
        try:
            self._nodes.receive(name_in_graph(node, self.get_namespace()), pairs)
        except DdctError as error:
            self._on_second_node(error)
        parts = self._nodes.torque_parts
        present = [TORQUE_PARTS.name] if parts else []
        self._bag.write_ticks([] if parts is None else self._buffer.decide(present))

    def _on_second_node(self, error: DdctError) -> None:
        """Raise the error; once a real-time run has begun, keep it until the clutch is open."""
        if self.known.lockstep or not self._bag.is_open:
            raise error
        if self._second_node is None:
            self._second_node = error
            self.get_logger().error(str(error))

    def _on_timing(self, cdr: bytes) -> None:
        _, pairs = CONTROLLER_TIMING.read(_message(CONTROLLER_TIMING, cdr))
        self._wall_clock.add_update_times(update_times(pairs))
        self._bag.write_unordered(CONTROLLER_TIMING, cdr)

    def _on_diagnostics(self, cdr: bytes) -> None:
        message = _message(DIAGNOSTICS, cdr)
        if not message.status:
            return
        # Every graph of the domain publishes on this topic, whatever its namespace.
        given, pairs = DIAGNOSTICS.read(message)
        name = StatusName.of(given, self.get_namespace())
        if self._nodes.has(name.node) and self._wall_clock.receive(name, pairs):
            message.status[0].name = str(name)
            self._bag.write_unordered(DIAGNOSTICS, serialize_message(message))

    def _acknowledge(self, stamp: int) -> bytes:
        """Publish the acknowledgement of a tick and return it, serialised."""
        ack = self._serialise_ack(stamp)
        self._ack.publish(ack)
        self._acknowledged = stamp
        return ack

    def _same_message(self, topic: str, first: bytes, second: bytes) -> bool:
        type_name = next(spec.type for spec in self._topics if spec.name == topic)
        normaliser = CdrNormaliser(load_definition(type_name))
        return normaliser.normalise(first) == normaliser.normalise(second)

    def _waiting_for(self) -> str:
        if missing := self._nodes.missing():
            return (
                f'no run_info came from {", ".join(missing)}: start them, or leave them out of '
                '--ros-args -p nodes:=[...]'
            )
        if lacking := self._buffer.missing():
            return (
                f'no whole tick came, for want of {", ".join(lacking)}: see the logs of the nodes '
                'that publish them, and of those before them'
            )
        return (
            'no whole tick came: start it first, or driveline with '
            '--ros-args -p require_recorder:=true'
        )

    def _warn_of_early_end(self) -> None:
        """Warn that steps are missing, unless the engine has stalled or over-revved."""
        steps, planned = self._bag.steps, self._nodes.steps
        if steps >= planned:
            return
        cdr = self._buffer.last.get(JOINT_STATES.name)
        speed = _message(JOINT_STATES, cdr).velocity[0] if cdr else math.nan
        if not self.settings.scenario.end_cause(speed):
            self.get_logger().warning(
                f'{self._recording.folder}: ended after {steps} of {planned} steps: not valid'
            )

    def _warn_of_missing_nodes(self) -> None:
        self._patience.cancel()
        if self._nodes.missing():
            self.get_logger().warning(self._waiting_for())


def _message(topic: Topic, cdr: bytes) -> Any:
    return deserialize_message(cdr, topic.message_class)


def main() -> int:
    """Record until stopped."""
    return run_node('recorder', RecorderNode)


if __name__ == '__main__':
    raise SystemExit(main())
