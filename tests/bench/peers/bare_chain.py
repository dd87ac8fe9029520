# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The graph's topics, hops and processes in bare rclpy, doing no work: the floor of `make bench`.

Each node publishes its constant messages as soon as it has received its inputs, with the same QoS,
executor and message sizes as the real graph. Run one node per process with `python bare_chain.py
NODE STEPS [PATIENCE_S]`, or all in one process with NODE `all`; `driveline` prints the time per
step. With `--shift` it is the graph of a gear shift. Nothing is sent twice, so no node may miss
the first message: see `_announce_when_ready`.
"""

import argparse
import json
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import rclpy
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Header

from ddct_plant.base.timebase import START_NS
from ddct_plant.graph.qos import LOOP_QOS, RECORDER_QOS
from ddct_plant.graph.spin import SLICE_S, make_executor
from ddct_plant.signals.points import TorqueRows
from ddct_plant.signals.signal import RunKind
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import recorded_topics

TICK = ('clutch/slip', 'driveline/joint_states', 'vehicle/twist', '/clock', 'vehicle/accel')
STATUS = tuple((f'a_key_of_the_status_{i}', '123.4567890123456') for i in range(4))
POINTS = [1.0] * 11

VALUES: dict[str, tuple[Any, ...]] = {
    'driveline/joint_states': ([1.0] * 4, [1.0] * 4, [1.0] * 4),
    'clutch/slip_reference': ([1.0], [1.0]),
    'controller/status': (STATUS,),
    'clutch/phase': (1.0, 1.0, ()),
    'off_going/clutch/phase': (1.0, 1.0, 1.0, ()),
}
"""Values of the message of a topic; others have the number 1, or a row of it, for each signal."""
SHIFT = RunKind(clutch='stick_slip', shift=True)
"""Kind of a gear shift, which has the topics of the off-going side."""

Examples = dict[str, Callable[[], Any]]
"""Function that makes a message, by topic of a tick; its size is that of the real graph."""


def _example(topic: Topic, kind: RunKind) -> Any:
    number = POINTS if isinstance(topic.kind, TorqueRows) else 1.0
    values = [number] * len(topic.signals_in(kind))
    return topic.message(START_NS, *VALUES.get(topic.name, values))


def examples_of(kind: RunKind) -> Examples:
    """Return the functions that make the messages of a tick of a kind of run."""
    topics = [topic for topic in recorded_topics(kind) if topic.every_tick]
    return {topic.name: partial(_example, topic, kind) for topic in topics}


EXAMPLES = examples_of(RunKind())
SHIFT_EXAMPLES = examples_of(SHIFT)

WIRING: dict[str, tuple[Sequence[str], Sequence[str]]] = {
    'engine': (['driveline/joint_states'], ['engine/torque', 'engine/torque_demand']),
    'load': (['vehicle/twist'], ['load/torque']),
    'reference': (['clutch/slip'], ['clutch/slip_reference']),
    'controller': (
        ['driveline/joint_states', 'vehicle/twist', 'engine/torque', 'clutch/slip_reference'],
        ['clutch/torque_request', 'controller/torque_parts', 'controller/status'],
    ),
    'actuator': (['clutch/torque_request'], ['actuator/torque']),
    'clutch': (['actuator/torque'], ['clutch/torque']),
    'recorder': ([topic for topic in EXAMPLES if topic != 'recorder/ack'], ['recorder/ack']),
    'driveline': (['engine/torque', 'load/torque', 'clutch/torque', 'recorder/ack'], TICK),
}
"""Topics that a node subscribes to and topics that it publishes, by node, as in the real graph."""
SHARE = 'clutch/handover_share'
SHIFT_WIRING: dict[str, tuple[Sequence[str], Sequence[str]]] = {
    **WIRING,
    'engine': (['driveline/joint_states', 'engine/torque_cut'], WIRING['engine'][1]),
    'load': (['vehicle/twist'], ['load/torque', 'load/holding_torque']),
    'handover': (
        ['driveline/joint_states', 'clutch/slip', 'off_going/clutch/slip', 'vehicle/twist'],
        [SHARE, 'off_going/clutch/torque_request', 'engine/torque_cut'],
    ),
    'reference': (['clutch/slip', SHARE], ['clutch/slip_reference']),
    'controller': ([*WIRING['controller'][0], SHARE], WIRING['controller'][1]),
    'clutch': (
        ['actuator/torque', 'clutch/slip', 'clutch/phase'],
        ['clutch/torque', 'clutch/temperature'],
    ),
    'off_going_actuator': (['off_going/clutch/torque_request'], ['off_going/actuator/torque']),
    'off_going_clutch': (
        ['off_going/actuator/torque', 'off_going/clutch/slip', 'off_going/clutch/phase'],
        ['off_going/clutch/torque', 'off_going/clutch/temperature'],
    ),
    'recorder': ([topic for topic in SHIFT_EXAMPLES if topic != 'recorder/ack'], ['recorder/ack']),
    'driveline': (
        [*WIRING['driveline'][0], 'load/holding_torque', 'off_going/clutch/torque'],
        [
            *(*TICK, 'clutch/phase', 'off_going/clutch/slip', 'off_going/clutch/phase'),
            'off_going/joint_states',
        ],
    ),
}
"""
The same in a gear shift, but that `handover` does not wait for the demand of the engine: a bare
node sends all its messages at once. So this chain has one hop less than the graph.
"""
Wiring = dict[str, tuple[list[str], list[str]]]


def wiring_with(more_nodes: int = 0, more_topics: int = 0) -> Wiring:
    """
    Return the wiring with further nodes `more_0`, ... and with further topics of the driveline.

    A further node answers `engine/torque` on a topic of its own, which the driveline waits for.
    The recorder subscribes to all of them.
    """
    wired = {name: (list(inputs), list(outputs)) for name, (inputs, outputs) in WIRING.items()}
    driveline = wired.pop('driveline')
    for i in range(more_nodes):
        wired[f'more_{i}'] = (['engine/torque'], [f'more/node_{i}'])
        driveline[0].append(f'more/node_{i}')
    driveline[1].extend(f'more/topic_{i}' for i in range(more_topics))
    wired['recorder'][0].extend(
        [*driveline[0][len(WIRING['driveline'][0]) :], *driveline[1][len(TICK) :]]
    )
    return wired | {'driveline': driveline}


def shift_wiring() -> Wiring:
    """Return the wiring of a gear shift, the driveline last."""
    others = (name for name in SHIFT_WIRING if name != 'driveline')
    return {
        name: (list(SHIFT_WIRING[name][0]), list(SHIFT_WIRING[name][1]))
        for name in (*others, 'driveline')
    }


def example_of(topic: str, examples: Examples) -> Any:
    """Return a message of a topic; a further topic has messages like `load/torque`."""
    return examples.get(topic, examples['load/torque'])()


READY = 'ready'
"""Prefix of topics: `ready/NODE` has a publisher, which sends nothing, once NODE is matched."""
POLL_S = 0.05
PATIENCE_S = 60.0
"""Timeout of the driveline for the start of the other nodes, or the answer to a tick, s."""


class BareNode(Node):
    """Node that publishes all its outputs once it has received every input once more."""

    def __init__(self, name: str, wiring: Wiring, examples: Examples) -> None:
        super().__init__(f'bare_{name}')
        self._name = name
        self._wiring = wiring
        inputs, outputs = wiring[name]
        self._expected = len(inputs)
        self._received = 0
        messages = {topic: example_of(topic, examples) for topic in (*inputs, *outputs)}
        self._outputs = [
            (self.create_publisher(type(messages[topic]), topic, LOOP_QOS), messages[topic])
            for topic in outputs
        ]
        raw = name == 'recorder'
        for topic in inputs:
            kind = type(messages[topic])
            qos = RECORDER_QOS if raw else LOOP_QOS
            self.create_subscription(kind, topic, self.receiver(topic), qos, raw=raw)
        self._match_timer = self.create_timer(POLL_S, self._announce_when_ready)

    def _announce_when_ready(self) -> None:
        """
        Create the publisher of `ready/NODE` once all endpoints of this node are matched.

        Discovery is not symmetric: a writer may be matched with its reader before the reader is
        matched with the writer and receives its messages. Once both are, no message is lost.
        """
        inputs = [topic for wired in self._wiring.values() for topic in wired[0]]
        matched = all(
            publisher.get_subscription_count() == inputs.count(topic)
            for (publisher, _), topic in zip(
                self._outputs, self._wiring[self._name][1], strict=True
            )
        )
        if matched and all(each.get_publisher_count() == 1 for each in self.subscriptions):
            self._match_timer.cancel()
            self.create_publisher(Header, f'{READY}/{self._name}', 1)

    def receiver(self, topic: str) -> Callable[[Any], None]:
        """Return the callback of a topic; all topics count alike."""
        return self._receive

    def _receive(self, _: Any) -> None:
        self._received += 1
        if self._received == self._expected:
            self._received = 0
            self.complete()

    def complete(self) -> None:
        """Answer the tick: publish every output."""
        self.send()

    def send(self) -> None:
        """Publish every output."""
        for publisher, message in self._outputs:
            publisher.publish(message)


class BareDriveline(BareNode):
    """Node that begins a tick when the last one is answered, and the first once all are ready."""

    def __init__(self, steps: int, wiring: Wiring, examples: Examples) -> None:
        super().__init__('driveline', wiring, examples)
        self.done: Future = Future()
        self.left = steps
        self._steps = steps
        self._started = 0.0
        self._begin = self.create_timer(POLL_S, self._begin_when_ready)

    def _begin_when_ready(self) -> None:
        if not self._not_ready():
            self._begin.cancel()
            self._started = time.perf_counter()
            self.send()

    def _not_ready(self) -> list[str]:
        return [name for name in self._wiring if not self.count_publishers(f'{READY}/{name}')]

    def timeout_message(self, patience_s: float) -> str:
        """Return the error message for a timeout of `patience_s` seconds."""
        if not self._started:
            return f'not ready after {patience_s:g} s: {", ".join(self._not_ready())}'
        return f'no answer to step {self._steps - self.left} within {patience_s:g} s'

    def complete(self) -> None:
        """Count the tick and begin the next one; after the last print the time per step in s."""
        self.left -= 1
        if self.left:
            self.send()
            return
        elapsed = time.perf_counter() - self._started
        print(json.dumps({'step_s': elapsed / self._steps}), flush=True)
        self.done.set_result(None)


def main() -> None:
    """Run the node of the command line, or all of them, until the driveline has done its steps."""
    options = _options()
    wiring = wiring_with(options.more_nodes, options.more_topics)
    examples = EXAMPLES
    if options.shift:
        wiring, examples = shift_wiring(), SHIFT_EXAMPLES
    rclpy.init()
    names = list(wiring) if options.node == 'all' else [options.node]
    nodes = [
        BareDriveline(options.steps, wiring, examples)
        if name == 'driveline'
        else BareNode(name, wiring, examples)
        for name in names
    ]
    executor = make_executor()
    for node in nodes:
        executor.add_node(node)
    try:
        if isinstance(nodes[-1], BareDriveline):
            spin_driveline(executor, nodes[-1], options.patience_s)
        while 'driveline' not in names:
            executor.spin_once(SLICE_S)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    rclpy.try_shutdown()


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description='Run a node of the bare chain, or all of them.')
    parser.add_argument('node')
    parser.add_argument('steps', type=int)
    parser.add_argument('patience_s', type=float, nargs='?', default=PATIENCE_S)
    parser.add_argument('--more-nodes', type=int, default=0)
    parser.add_argument('--more-topics', type=int, default=0)
    parser.add_argument('--shift', action='store_true')
    return parser.parse_args()


def spin_driveline(executor: Executor, driveline: BareDriveline, patience_s: float) -> None:
    """Spin until the run is done; end the program with an error when no step ends in time."""
    left, since = driveline.left, time.monotonic()
    while not driveline.done.done():
        executor.spin_until_future_complete(driveline.done, SLICE_S)
        if driveline.left != left:
            left, since = driveline.left, time.monotonic()
        elif time.monotonic() - since > patience_s:
            sys.exit(f'bare_chain: {driveline.timeout_message(patience_s)}')


if __name__ == '__main__':
    main()
