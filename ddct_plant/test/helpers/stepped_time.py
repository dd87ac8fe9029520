# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Virtual time: nodes wait by a clock that the test advances, and exactly the due timers fire."""

from collections.abc import Callable

from ddct_plant.graph.steady_time import SteadyTime


class SteppedTimer:
    """A timer of `SteppedTime`."""

    def __init__(self, due_ns: int, period_ns: int, call: Callable[[], object]) -> None:
        """Be due at a time; later each `period_ns`."""
        self.due_ns, self.period_ns, self.call = due_ns, period_ns, call
        self.active = True

    def cancel(self) -> None:
        """Fire no more."""
        self.active = False


class SteppedTime(SteadyTime):
    """
    Time that stands still but for the steps of a test; all nodes of a graph may have the same.

    A timer fires within the step, in the thread of the test. As on a real clock, a reading is
    later than the one before it: by 1 ns.
    """

    def __init__(self) -> None:
        """Start at 0."""
        self._now_ns = 0
        self._timers: list[SteppedTimer] = []

    def monotonic_ns(self) -> int:
        """Return the time in ns; it takes 1 ns."""
        self._now_ns += 1
        return self._now_ns

    def every(
        self, _node: object, period_s: float, callback: Callable[[], object]
    ) -> SteppedTimer:
        """Call a function every `period_s`."""
        period_ns = round(1e9 * period_s)
        timer = SteppedTimer(self._now_ns + period_ns, period_ns, callback)
        self._timers.append(timer)
        return timer

    def step(self, latest_s: float | None = None) -> bool:
        """
        Go on to the next time at which a timer is due, and fire the timers of that time.

        Return False, and leave the time, where none is due, or none until `latest_s`.
        """
        self._timers = [timer for timer in self._timers if timer.active]
        due = min((timer.due_ns for timer in self._timers), default=None)
        if due is None or (latest_s is not None and due > round(1e9 * latest_s)):
            return False
        self._now_ns = max(self._now_ns, due)
        self._fire(due)
        return True

    def advance(self, seconds: float, between: Callable[[], object] = lambda: None) -> None:
        """Let time pass; `between()` is called after each time at which timers have fired."""
        end_ns = self._now_ns + round(1e9 * seconds)
        while self.step(1e-9 * end_ns):
            between()
        self._now_ns = max(self._now_ns, end_ns)

    def jump(self, seconds: float) -> None:
        """Let time pass without the process: each timer that was due meanwhile fires once."""
        self._now_ns += round(1e9 * seconds)
        self._fire(self._now_ns)

    def _fire(self, due_ns: int) -> None:
        for timer in sorted(self._timers, key=lambda timer: timer.due_ns):
            if timer.active and timer.due_ns <= due_ns:
                periods = 1 + (due_ns - timer.due_ns) // max(timer.period_ns, 1)
                timer.due_ns += periods * max(timer.period_ns, 1)
                timer.call()
