# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The bare chain at 99.9 Hz on a steady clock: the floor of a real-time run.

`python -P -m soak.paced_chain NODE STEPS` runs one node. The driveline publishes a tick every
10.01 ms, whether or not the one before is answered, and prints what it measured as JSON. So each
side meets every phase of the other's ticks once in 10 s, and neither has the better one. The nodes
only count their messages, so none may be lost: it skips ticks, which count as missed, while more
than `MOST_OUTSTANDING` are unanswered, fewer than the depth of the queues.
"""

import json
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import rclpy
from rclpy.clock import Clock, ClockType

from bench.chain import WIRING, BareDriveline, BareNode, spin
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.ticks.durations import TickDurations

PACE_S = 1.001 * PERIOD_S
"""Period of the ticks, s."""
MOST_OUTSTANDING = 8
"""Most ticks without an answer at which another one is published."""
ACK = 'recorder/ack'
"""Topic that ends no tick: in real time nobody waits for the recorder."""


class PacedDriveline(BareDriveline):
    """Driveline that publishes a tick every period from the first answer on."""

    def __init__(self, steps: int) -> None:
        """Take the number of ticks."""
        self._answers = dict.fromkeys(WIRING['driveline'][0], 0)
        super().__init__(steps)
        self.durations = TickDurations(time.monotonic)
        self.missed = 0
        self._sent = 0
        self._grid_from: float | None = None

    def receiver(self, topic: str) -> Callable[[Any], None]:
        """Return the callback of a topic: replies are counted by topic."""
        return partial(self._answer, topic)

    def send(self) -> None:
        """Publish a tick."""
        self._sent += 1
        super().send()

    def _answered(self) -> int:
        return min(count for topic, count in self._answers.items() if topic != ACK)

    def _answer(self, topic: str, _: Any) -> None:
        self._answers[topic] += 1
        if topic == 'clutch/torque':
            self.durations.answer(self._answers[topic] - 1)
        if self._grid_from is None and self._answered() == 1:
            self._grid_from = time.monotonic()
            self.create_timer(PACE_S, self._tick, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _tick(self) -> None:
        assert self._grid_from is not None
        while self.left:
            late_s = time.monotonic() - self._grid_from - (self._steps - self.left + 1) * PACE_S
            if late_s < 0.0:
                return
            self.left -= 1
            outstanding = self._sent - self._answered()
            self.missed += outstanding > 0
            if outstanding <= MOST_OUTSTANDING:
                self.durations.publish(late_s)
                self.send()
        if not self.done.done():
            self.done.set_result(None)

    def result(self) -> dict[str, Any]:
        """Return what was measured, in the form of `timing.json`."""
        return {
            'steps': self._steps,
            'missed_steps': self.missed,
            'lateness_us': [1e6 * each for each in self.durations.lateness],
            'latency_us': [1e6 * each for each in self.durations.latency],
        }


def main() -> None:
    """Run the node of the command line until the driveline has done its steps."""
    name, steps = sys.argv[1], int(sys.argv[2])
    rclpy.init()
    node = PacedDriveline(steps) if name == 'driveline' else BareNode(name)
    spin([node])
    if isinstance(node, PacedDriveline):
        print(json.dumps(node.result()), flush=True)
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
