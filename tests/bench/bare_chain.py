"""
The graph's topics, hops and processes in bare rclpy, doing no work: the floor of `make bench`.

Each node publishes its constant messages as soon as it has heard its inputs, with the same QoS,
executor and message sizes as the real graph. Run one node per process with `python bare_chain.py
NODE STEPS`, or all in one process with NODE `all`; `driveline` prints microseconds per step.
"""

import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.task import Future

from ddct_plant.graph import messages
from ddct_plant.graph.qos import LOOP_QOS, RECORDER_QOS
from ddct_plant.graph.spin import SLICE_S, make_executor
from ddct_plant.timebase import START_NS

TICK = ('/clock', 'clutch/slip', 'driveline/joint_states', 'vehicle/twist', 'vehicle/accel')
STATUS = tuple((f'a_key_of_the_status_{i}', '123.4567890123456') for i in range(4))
POINTS = [1.0] * 11

EXAMPLES: dict[str, Callable[[], Any]] = {
    '/clock': lambda: messages.clock_message(START_NS),
    'clutch/slip': lambda: messages.slip_message(START_NS, 1.0),
    'driveline/joint_states': lambda: messages.joint_states_message(
        START_NS, [1.0] * 4, [1.0] * 4, [1.0] * 4
    ),
    'vehicle/twist': lambda: messages.twist_message(START_NS, 1.0),
    'vehicle/accel': lambda: messages.accel_message(START_NS, 1.0),
    'engine/torque_demand': lambda: messages.torque_message(START_NS, 1.0),
    'engine/torque': lambda: messages.torque_message(START_NS, 1.0),
    'load/torque': lambda: messages.torque_message(START_NS, 1.0),
    'clutch/slip_reference': lambda: messages.slip_reference_message(START_NS, [1.0], [1.0]),
    'clutch/torque_request': lambda: messages.torque_message(START_NS, 1.0),
    'controller/status': lambda: messages.status_message(START_NS, 'controller', STATUS),
    'actuator/torque': lambda: messages.torque_points_message(START_NS, POINTS),
    'clutch/torque': lambda: messages.torque_points_message(START_NS, POINTS),
    'recorder/ack': lambda: messages.ack_message(START_NS),
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


class BareNode(Node):
    """Publish all outputs once every input has come once more."""

    def __init__(self, name: str) -> None:
        super().__init__(f'bare_{name}')
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
    """Begin each tick when the last is answered, once every publisher and reader is there."""

    def __init__(self, steps: int) -> None:
        super().__init__('driveline')
        self.done: Future = Future()
        self._left = steps
        self._steps = steps
        self._started = 0.0
        self._settled = 0
        self._begin = self.create_timer(0.05, self._begin_when_matched)

    def _begin_when_matched(self) -> None:
        topics = {topic for wiring in WIRING.values() for topics in wiring for topic in topics}
        inputs = [topic for wiring in WIRING.values() for topic in wiring[0]]
        whole = all(
            self.count_publishers(topic) == 1
            and self.count_subscribers(topic) == inputs.count(topic)
            for topic in topics
        )
        # Discovery is not symmetric: others may see the last node a little later than we do.
        self._settled = self._settled + 1 if whole else 0
        if self._settled == 20:
            self._begin.cancel()
            self._started = time.perf_counter()
            self.send()

    def complete(self) -> None:
        """Count the tick and begin the next one."""
        self._left -= 1
        if self._left:
            self.send()
            return
        elapsed = time.perf_counter() - self._started
        print(f'{1e6 * elapsed / self._steps:.1f}', flush=True)
        self.done.set_result(None)


def main() -> None:
    """Run the named node, or all of them, until the driveline has done its steps."""
    name, steps = sys.argv[1], int(sys.argv[2])
    rclpy.init()
    names = list(WIRING) if name == 'all' else [name]
    nodes = [BareDriveline(steps) if one == 'driveline' else BareNode(one) for one in names]
    executor = make_executor()
    for node in nodes:
        executor.add_node(node)
    done = nodes[-1].done if 'driveline' in names else Future()
    try:
        while not done.done():
            executor.spin_until_future_complete(done, SLICE_S)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
