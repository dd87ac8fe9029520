# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What runs on a network of `tick_network` must give, without joins, stamps or messages."""

from tick_network import Wiring, answer_of, digest

CLUTCH_STEPS = 5
"""Steps for which the torque of a clutch may be missing before the clutch opens."""
RAMP_N_M = 10.0
"""Torque in N m that an opening clutch loses in a step."""


class RightRun:
    """The undisturbed run, computed step by step without joins, stamps or messages."""

    def __init__(self, wiring: Wiring, steps: int) -> None:
        self.ticks: list[dict[str, float]] = []
        """By step the right value of each topic."""
        state = 0.0
        for step in range(steps + 1):
            values = {topic: digest(topic, step, state) for topic in wiring.ticks}
            open_nodes = dict(wiring.nodes)
            while open_nodes:
                name = next(n for n, w in open_nodes.items() if set(w.inputs) <= set(values))
                wires = open_nodes.pop(name)
                inputs = {topic: values[topic] for topic in wires.inputs}
                values |= {topic: answer_of(topic, step, inputs) for topic in wires.outputs}
            self.ticks.append(values)
            state = digest(step, [values[topic] for topic in wiring.torques])


class HeldTorque:
    """The torque that a step must have, by the page on real time: one topic of the driveline."""

    def __init__(self, opens: bool) -> None:
        self.opens = opens
        """Whether it is a clutch, which opens when it is not heard of for too long."""
        self.safe = False
        self.heard_at = 0
        self.value = 0.0

    def over(self, step: int, value: float | None) -> tuple[float, float]:
        """Return the torque at begin and end of a period, with what came in time or None."""
        if value is not None:
            self.heard_at = step
            if not self.safe:
                self.value = value
        if self.opens and value is None and step - self.heard_at > CLUTCH_STEPS:
            self.safe = True
        begin = self.value
        if self.safe:
            self.value = max(begin - RAMP_N_M, 0.0)
        return begin, self.value
