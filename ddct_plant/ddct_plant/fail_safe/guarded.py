"""Actuator and engine with their safe states, on the grid of the ticks; knows nothing of ROS."""

from abc import ABC, abstractmethod
from typing import Generic, TypeVar

from ddct_plant.fail_safe.request_watch import (
    MOST_CATCH_UP_STEPS,
    REQUEST_TIMEOUT_S,
    FailSafe,
    FailSafeSettings,
    RequestWatch,
)
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.engine import Engine

Answer = TypeVar('Answer')
"""What is delivered over one period."""


def engine_info(two_input: bool, request_timeout_s: float = REQUEST_TIMEOUT_S) -> dict[str, str]:
    """Return what the engine says of itself: whether it waits for requests, and how long [s]."""
    return {'two_input': str(two_input).lower(), 'request_timeout_s': repr(request_timeout_s)}


def steps_to_make_up(next_step: int, step: int) -> range:
    """Return the steps before `step`, from the first not yet answered, that still count."""
    return range(max(next_step, step - MOST_CATCH_UP_STEPS), step)


class Guarded(ABC, Generic[Answer]):
    """
    A device as requests and ticks drive it.

    In lock-step only requests do. In real time, steps without a request hold the last one; when
    requests stop for longer than the timeout, the safe state takes over and no request is obeyed
    any more.
    """

    def __init__(self, watch: RequestWatch, held_request: float | None) -> None:
        """Start at step 0 with what is held until the first request: None for the safe state."""
        self.watch = watch
        self._held_request = held_request
        self._next_step = 0
        self._answer: Answer | None = None

    def request(self, step: int, torque: float) -> Answer | None:
        """
        Return what is delivered over the period of `step`, for a request in N m.

        None where the request is not obeyed: it is late, or the safe state has taken over.
        """
        self.watch.request(step)
        if self.watch.stopped or step < self._next_step:
            return None
        return self._advance(step, torque)

    def tick(self, step: int) -> Answer | None:
        """Return the same at a tick, None as long as requests are waited for or obeyed."""
        if not self._goes_without(step):
            return None
        if step >= self._next_step:
            self._advance(step, None)
        # A tick that comes again gets the same answer; an older one gets none.
        return self._answer if step == self._next_step - 1 else None

    def _goes_without(self, step: int) -> bool:
        """Say at the start of `step` whether requests are waited for no longer."""
        return self.watch.tick(step)

    def _advance(self, step: int, request: float | None) -> Answer:
        """Make up for the steps before `step` with what was held, then deliver `request`."""
        for missed in steps_to_make_up(self._next_step, step):
            self._deliver(missed, self._held_request)
        self._held_request = request
        self._next_step = step + 1
        self._answer = self._deliver(step, request)
        return self._answer

    @abstractmethod
    def _deliver(self, step: int, request: float | None) -> Answer:
        """Return what a request in N m, or without one the safe state, makes of one period."""


class GuardedActuator(Guarded[list[float]]):
    """The actuator; it delivers (11,) torques in N m, and its safe state opens the clutch."""

    def __init__(
        self, actuator: Actuator, initial_request: float, settings: FailSafeSettings
    ) -> None:
        """Guard an actuator that is at rest on `initial_request` in N m."""
        self._actuator = actuator
        self._fail_safe = FailSafe(settings)
        super().__init__(self._fail_safe, initial_request)

    def _advance(self, step: int, request: float | None) -> list[float]:
        if self._held_request is None:
            # The ramp goes on over those steps too that are too many to be made up for.
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
    An engine with two inputs; it delivers C_m in N m, in its safe state for the driver's demand.

    Until the first request the demand holds too.
    """

    def __init__(self, engine: Engine, timeout_s: float) -> None:
        """Wait for requests for `timeout_s` in s."""
        super().__init__(RequestWatch(timeout_s), None)
        self._engine = engine
        self.speed = 0.0
        """w_m in rad/s over the periods that are delivered next."""

    def _goes_without(self, step: int) -> bool:
        return super()._goes_without(step) if self.watch.heard else self.watch.too_long(0, step)

    def _deliver(self, step: int, request: float | None) -> float:
        if request is None:
            request = self._engine.demand(step)
        return self._engine.torque(step, request, self.speed)
