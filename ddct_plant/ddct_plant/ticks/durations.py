# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""How late the ticks of a real-time run are, and how long their answers take."""

from collections.abc import Callable


class TickDurations:
    """Durations of the ticks of a real-time run in s, measured where time is owned."""

    def __init__(self, clock: Callable[[], float]) -> None:
        """Measure by a steady clock in s."""
        self.lateness: list[float] = []
        """Time by which each step began after it was due."""
        self.latency: list[float] = []
        """Time from the publication of a tick to each torque of a clutch that answers it,
        however late."""
        self._clock = clock
        self._sent_at: list[float] = []

    def publish(self, late_s: float) -> None:
        """Note that the next tick, the first one with step 1, is published; its step was late."""
        self.lateness.append(late_s)
        self._sent_at.append(self._clock())

    def answer(self, step: int) -> None:
        """Note the arrival of a reply to the tick of a step, which may be a false one."""
        if 0 < step <= len(self._sent_at):
            self.latency.append(self._clock() - self._sent_at[step - 1])

    def take(self) -> tuple[list[float], list[float]]:
        """Return the samples of lateness and latency since the last call."""
        taken = self.lateness, self.latency
        self.lateness, self.latency = [], []
        return taken
