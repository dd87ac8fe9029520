# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Actuator and engine with their safe states, on the grid of the ticks; independent of ROS."""

from abc import ABC, abstractmethod
from typing import Generic, TypeVar

from ddct_plant.fail_safe.request_watch import (
    MOST_CATCH_UP_STEPS,
    FailSafe,
    FailSafeSettings,
    RequestWatch,
)
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.engine import Engine

Answer = TypeVar('Answer')
"""Type of the torque that a device delivers over one period."""


def steps_to_make_up(next_step: int, step: int) -> range:
    """Return the unanswered steps before `step`, at most the last `MOST_CATCH_UP_STEPS`."""
    return range(max(next_step, step - MOST_CATCH_UP_STEPS), step)


class Guarded(ABC, Generic[Answer]):
    """
    A device that requests and ticks advance, with a safe state.

    In lock-step only requests advance it. In real time, steps without a request hold the last one;
    when requests stop for longer than the timeout, the safe state takes over and later requests
    are ignored.
    """

    def __init__(self, watch: RequestWatch, held_request: float | None) -> None:
        """Start at step 0 with `held_request` in N m until the first one; None: safe state."""
        self.watch = watch
        self._held_request = held_request
        self._next_step = 0
        self._answer: Answer | None = None

    def request(self, step: int, torque: float) -> Answer | None:
        """
        Return the delivered torque over the period of `step`, for a request in N m.

        None where the request is ignored: it is late, or the safe state has taken over.
        """
        self.watch.request(step)
        if self.watch.stopped or step < self._next_step:
            return None
        return self._advance(step, torque)

    def tick(self, step: int) -> Answer | None:
        """Return the torque at a tick without request, None while requests are expected."""
        if not self._goes_without(step):
            return None
        if step >= self._next_step:
            self._advance(step, None)
        # A repeated tick gets the same answer; an older one gets none.
        return self._answer if step == self._next_step - 1 else None

    def _goes_without(self, step: int) -> bool:
        """Return at the start of `step` whether requests are no longer expected."""
        return self.watch.tick(step)

    def _advance(self, step: int, request: float | None) -> Answer:
        """Deliver the held request for the steps before `step`, then `request`."""
        for missed in steps_to_make_up(self._next_step, step):
            self._deliver(missed, self._held_request)
        self._held_request = request
        self._next_step = step + 1
        self._answer = self._deliver(step, request)
        return self._answer

    @abstractmethod
    def _deliver(self, step: int, request: float | None) -> Answer:
        """Return the torque over one period for a request in N m, None: in the safe state."""


class GuardedActuator(Guarded[list[float]]):
    """The actuator: it delivers (11,) torques in N m, and opens the clutch in its safe state."""

    def __init__(
        self, actuator: Actuator, initial_request: float, settings: FailSafeSettings
    ) -> None:
        """Guard an actuator in its steady state for `initial_request` in N m."""
        self._actuator = actuator
        self._fail_safe = FailSafe(settings)
        super().__init__(self._fail_safe, initial_request)

    def _advance(self, step: int, request: float | None) -> list[float]:
        if self._held_request is None:
            # The ramp also goes on over the steps beyond the limit of the catch-up.
            forgotten = step - self._next_step - MOST_CATCH_UP_STEPS
            self._fail_safe.next_torque(max(forgotten, 0))
        return super()._advance(step, request)

    def _deliver(self, step: int, request: float | None) -> list[float]:
        if request is None:
            request = self._fail_safe.next_torque()
        self._fail_safe.torque = request
        return self._actuator.update(request)


class GuardedEngine(Guarded[float]):
    """
    An engine with two inputs: it delivers C_m in N m, and follows the demand in its safe state.

    It follows the demand until the first request, too.
    """

    def __init__(self, engine: Engine, timeout_s: float) -> None:
        """Guard an engine with a timeout of requests in s."""
        super().__init__(RequestWatch(timeout_s), None)
        self._engine = engine
        self.speed = 0.0
        """Engine speed w_m in rad/s for the next delivered periods."""

    def _goes_without(self, step: int) -> bool:
        return super()._goes_without(step) if self.watch.received else self.watch.too_long(0, step)

    def _deliver(self, step: int, request: float | None) -> float:
        demand = self._engine.demand(step)
        return self._engine.torque(demand, demand if request is None else request, self.speed)
