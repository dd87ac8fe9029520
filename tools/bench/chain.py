# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The graph's topics, hops and processes in bare rclpy, doing no work: the floor of a step.

Each node publishes its constant messages as soon as it has received its inputs, with the same QoS,
executor and message sizes as the real graph. `python -P -m bench.chain NODE STEPS` runs one node
per process, or all in one process with NODE `all`; `driveline` prints the time per step. Nothing
is sent twice, so no node may miss the first message: see `_announce_when_ready`.
"""

import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from typing import Any

import rclpy
from rclpy.executors import Executor, ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Header

from bench.workspaces import ProgramError
from ddct_plant.base.timebase import START_NS
from ddct_plant.graph.domain import own_domain
from ddct_plant.graph.qos import LOOP_QOS, RECORDER_QOS
from ddct_plant.graph.spin import SLICE_S, make_executor
from ddct_plant.signals.topic import RunKind, Topic
from ddct_plant.signals.topics import recorded_topics

VALUES: dict[str, tuple[Any, ...]] = {
    'driveline/joint_states': ([1.0] * 4, [1.0] * 4, [1.0] * 4),
    'clutch/slip_reference': ([1.0], [1.0]),
    'controller/status': (tuple((f'a_key_of_the_status_{i}', 17 * '1') for i in range(4)),),
}
"""Values of the message of a topic; others have the number 1, or a row of it, for each signal."""


def _example(topic: Topic) -> Any:
    signals = topic.signals_in(RunKind())
    values = [1.0 if signal.size == 1 else [1.0] * (signal.size or 1) for signal in signals]
    return topic.message(START_NS, *VALUES.get(topic.name, values))


EXAMPLES: dict[str, Callable[[], Any]] = {
    topic.name: partial(_example, topic)
    for topic in recorded_topics(RunKind())
    if topic.every_tick
}
"""Function that makes a message, by topic of a tick; its size is that of the real graph."""
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
    'driveline': (
        ['engine/torque', 'load/torque', 'clutch/torque', 'recorder/ack'],
        ['clutch/slip', 'driveline/joint_states', 'vehicle/twist', '/clock', 'vehicle/accel'],
    ),
}
"""Topics that a node subscribes to and topics that it publishes, by node, as in the real graph."""
READY = 'ready'
"""Prefix of topics: `ready/NODE` has a publisher, which sends nothing, once NODE is matched."""
POLL_S = 0.05
PATIENCE_S = 60.0
"""Timeout of the driveline for the start of the other nodes, or the answer to a tick, s."""
END_S = 20.0


class BareNode(Node):
    """Node that publishes all its outputs once it has received every input once more."""

    def __init__(self, name: str) -> None:
        """Create the publishers and subscriptions of the wiring."""
        super().__init__(f'bare_{name}')
        self._name = name
        inputs, outputs = WIRING[name]
        self._expected = len(inputs)
        self._received = 0
        self._outputs = [
            (self.create_publisher(type(message), topic, LOOP_QOS), message)
            for topic in outputs
            for message in [EXAMPLES[topic]()]
        ]
        raw = name == 'recorder'
        for topic in inputs:
            qos = RECORDER_QOS if raw else LOOP_QOS
            kind = type(EXAMPLES[topic]())
            self.create_subscription(kind, topic, self.receiver(topic), qos, raw=raw)
        self._match_timer = self.create_timer(POLL_S, self._announce_when_ready)

    def _announce_when_ready(self) -> None:
        """
        Create the publisher of `ready/NODE` once all endpoints of this node are matched.

        Discovery is not symmetric: a writer may be matched with its reader before the reader is
        matched with the writer and receives its messages. Once both are, no message is lost.
        """
        inputs = [topic for wired in WIRING.values() for topic in wired[0]]
        matched = all(
            publisher.get_subscription_count() == inputs.count(topic)
            for (publisher, _), topic in zip(self._outputs, WIRING[self._name][1], strict=True)
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

    def __init__(self, steps: int) -> None:
        """Take the number of ticks."""
        super().__init__('driveline')
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
        return [name for name in WIRING if not self.count_publishers(f'{READY}/{name}')]

    def timeout_message(self) -> str:
        """Return the error message for a timeout."""
        if not self._started:
            return f'not ready after {PATIENCE_S:g} s: {", ".join(self._not_ready())}'
        return f'no answer to step {self._steps - self.left} within {PATIENCE_S:g} s'

    def complete(self) -> None:
        """Count the tick and begin the next one; after the last print the time per step in s."""
        self.left -= 1
        if self.left:
            self.send()
            return
        print((time.perf_counter() - self._started) / self._steps, flush=True)
        self.done.set_result(None)


def chain_step_s(steps: int, *, single: bool = False) -> float:
    """Return the wall time per step in s of a chain in one process, or in one for each node."""
    with own_domain(), ExitStack() as stack:
        for name in ['all'] if single else WIRING:
            command = [sys.executable, '-P', '-m', 'bench.chain', name, str(steps)]
            process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
            stack.callback(_end, process)
        output, _ = process.communicate()
        if process.returncode:
            raise ProgramError('the bare chain failed; its reason is above')
    return float(output)


def _end(process: subprocess.Popen[str]) -> None:
    process.terminate()
    try:
        process.wait(END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def spin(nodes: Sequence[BareNode]) -> None:
    """
    Spin until the driveline has done its steps, without one until this process is ended.

    End the program with an error when no step ends in time.
    """
    executor: Executor = make_executor()
    for node in nodes:
        executor.add_node(node)
    driveline = nodes[-1]
    done = driveline.done if isinstance(driveline, BareDriveline) else Future()
    left, since = -1, time.monotonic()
    try:
        # To leave the executor after each message would take longer than the hop.
        while not done.done():
            executor.spin_until_future_complete(done, SLICE_S)
            if not isinstance(driveline, BareDriveline):
                continue
            if driveline.left != left:
                left, since = driveline.left, time.monotonic()
            elif time.monotonic() - since > PATIENCE_S:
                sys.exit(f'bare chain: {driveline.timeout_message()}')
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


def main() -> None:
    """Run the node of the command line, or all of them, until the driveline has done its steps."""
    node, steps = sys.argv[1], int(sys.argv[2])
    rclpy.init()
    spin(
        [
            BareDriveline(steps) if name == 'driveline' else BareNode(name)
            for name in (WIRING if node == 'all' else [node])
        ]
    )
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
