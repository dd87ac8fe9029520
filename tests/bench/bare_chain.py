"""
The graph's topics, hops and processes in bare rclpy, doing no work: the floor of `make bench`.

Each node publishes its constant messages as soon as it has heard its inputs, with the same QoS,
executor and message sizes as the real graph. Run one node per process with `python bare_chain.py
NODE STEPS [PATIENCE_S]`, or all in one process with NODE `all`; `driveline` prints microseconds
per step. Nothing is sent twice, so no node may miss the first message: see `_say_when_ready`.
"""

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
from ddct_plant.graph.topics import RunKind, Topic, recorded_topics

TICK = ('/clock', 'clutch/slip', 'driveline/joint_states', 'vehicle/twist', 'vehicle/accel')
STATUS = tuple((f'a_key_of_the_status_{i}', '123.4567890123456') for i in range(4))
POINTS = [1.0] * 11

VALUES: dict[str, tuple[Any, ...]] = {
    'driveline/joint_states': ([1.0] * 4, [1.0] * 4, [1.0] * 4),
    'clutch/slip_reference': ([1.0], [1.0]),
    'controller/status': (STATUS,),
    'actuator/torque': (POINTS,),
    'clutch/torque': (POINTS,),
}
"""What a topic carries; one number per signal where nothing is said."""


def _example(topic: Topic) -> Any:
    return topic.message(START_NS, *VALUES.get(topic.name, [1.0] * len(topic.signals)))


EXAMPLES: dict[str, Callable[[], Any]] = {
    topic.name: partial(_example, topic)
    for topic in recorded_topics(RunKind())
    if topic.every_tick
}
"""One message of each topic of a tick, of the size that the real graph sends."""

WIRING: dict[str, tuple[Sequence[str], Sequence[str]]] = {
    'engine': (['driveline/joint_states'], ['engine/torque', 'engine/torque_demand']),
    'load': (['vehicle/twist'], ['load/torque']),
    'reference': (['clutch/slip'], ['clutch/slip_reference']),
    'controller': (
        ['driveline/joint_states', 'vehicle/twist', 'engine/torque', 'clutch/slip_reference'],
        ['clutch/torque_request', 'controller/status'],
    ),
    'actuator': (['clutch/torque_request'], ['actuator/torque']),
    'clutch': (['actuator/torque'], ['clutch/torque']),
    'recorder': ([topic for topic in EXAMPLES if topic != 'recorder/ack'], ['recorder/ack']),
    'driveline': (['engine/torque', 'load/torque', 'clutch/torque', 'recorder/ack'], TICK),
}
"""Inputs and outputs of each node, as in the real graph."""


READY = 'ready'
"""`ready/NODE` has a publisher, which sends nothing, once that node has all its matches."""
POLL_S = 0.05
PATIENCE_S = 60.0
"""How long the driveline waits for the others to start, or for the answer to a tick."""


class BareNode(Node):
    """Publish all outputs once every input has come once more."""

    def __init__(self, name: str) -> None:
        super().__init__(f'bare_{name}')
        self._name = name
        inputs, outputs = WIRING[name]
        self._wanted = len(inputs)
        self._heard = 0
        self._outputs = [
            (self.create_publisher(type(EXAMPLES[topic]()), topic, LOOP_QOS), EXAMPLES[topic]())
            for topic in outputs
        ]
        raw = name == 'recorder'
        for topic in inputs:
            kind = type(EXAMPLES[topic]())
            qos = RECORDER_QOS if raw else LOOP_QOS
            self.create_subscription(kind, topic, self._hear, qos, raw=raw)
        self._looks = self.create_timer(POLL_S, self._say_when_ready)

    def _say_when_ready(self) -> None:
        """
        Look whether each of our endpoints is matched with those at its other end, and say so.

        Discovery is not symmetric: that a writer knows its reader does not yet mean that the
        reader takes in what it writes. Once both know each other, nothing is lost.
        """
        inputs = [topic for wiring in WIRING.values() for topic in wiring[0]]
        matched = all(
            publisher.get_subscription_count() == inputs.count(topic)
            for (publisher, _), topic in zip(self._outputs, WIRING[self._name][1], strict=True)
        )
        if matched and all(each.get_publisher_count() == 1 for each in self.subscriptions):
            self._looks.cancel()
            self.create_publisher(Header, f'{READY}/{self._name}', 1)

    def _hear(self, _: Any) -> None:
        self._heard += 1
        if self._heard == self._wanted:
            self._heard = 0
            self.complete()

    def complete(self) -> None:
        """Answer the tick."""
        self.send()

    def send(self) -> None:
        """Publish every output."""
        for publisher, message in self._outputs:
            publisher.publish(message)


class BareDriveline(BareNode):
    """Begin each tick when the last is answered, the first once every node is ready."""

    def __init__(self, steps: int) -> None:
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

    def complaint(self, patience_s: float) -> str:
        """Return what to say after waiting in vain."""
        if not self._started:
            return f'not ready after {patience_s:g} s: {", ".join(self._not_ready())}'
        return f'no answer to step {self._steps - self.left} within {patience_s:g} s'

    def complete(self) -> None:
        """Count the tick and begin the next one."""
        self.left -= 1
        if self.left:
            self.send()
            return
        elapsed = time.perf_counter() - self._started
        print(f'{1e6 * elapsed / self._steps:.1f}', flush=True)
        self.done.set_result(None)


def main() -> None:
    """Run the named node, or all of them, until the driveline has done its steps."""
    name, steps = sys.argv[1], int(sys.argv[2])
    patience_s = float(sys.argv[3]) if len(sys.argv) > 3 else PATIENCE_S
    rclpy.init()
    names = list(WIRING) if name == 'all' else [name]
    nodes = [BareDriveline(steps) if one == 'driveline' else BareNode(one) for one in names]
    executor = make_executor()
    for node in nodes:
        executor.add_node(node)
    try:
        if isinstance(nodes[-1], BareDriveline):
            spin_driveline(executor, nodes[-1], patience_s)
        while 'driveline' not in names:
            executor.spin_once(SLICE_S)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    rclpy.try_shutdown()


def spin_driveline(executor: Executor, driveline: BareDriveline, patience_s: float) -> None:
    """Spin until it is done; end the program with a line when nothing happens for too long."""
    left, since = driveline.left, time.monotonic()
    while not driveline.done.done():
        executor.spin_until_future_complete(driveline.done, SLICE_S)
        if driveline.left != left:
            left, since = driveline.left, time.monotonic()
        elif time.monotonic() - since > patience_s:
            sys.exit(f'bare_chain: {driveline.complaint(patience_s)}')


if __name__ == '__main__':
    main()
