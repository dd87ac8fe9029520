"""The engine that a controller commands, on the grid of the ticks; knows nothing of ROS."""

from ddct_plant.fail_safe.request_watch import REQUEST_TIMEOUT_S, RequestWatch, steps_to_make_up
from ddct_plant.models.engine import Engine


def engine_info(two_input: bool, request_timeout_s: float = REQUEST_TIMEOUT_S) -> dict[str, str]:
    """Return what the engine says of itself: whether it waits for requests, and how long [s]."""
    return {'two_input': str(two_input).lower(), 'request_timeout_s': repr(request_timeout_s)}


class GuardedEngine:
    """
    An engine with two inputs as requests and ticks drive it.

    In lock-step only requests do. In real time, steps without a request hold the last one; when
    requests stop for longer than the timeout, the driver's demand takes over and no request is
    obeyed any more. Until the first request the demand holds.
    """

    def __init__(self, engine: Engine, timeout_s: float) -> None:
        """Wait for requests for `timeout_s` in s."""
        self._engine = engine
        self._watch = RequestWatch(timeout_s)
        self._held_request: float | None = None
        self._next_step = 0
        self._torque = 0.0
        self._speed = 0.0

    @property
    def on_demand(self) -> bool:
        """Whether the demand has taken over because requests stopped."""
        return self._watch.stopped

    def request(self, step: int, torque: float, speed: float = 0.0) -> float | None:
        """
        Return C_m in N m over the period of `step`, for a request in N m, at w_m in rad/s.

        None where the request is not obeyed: it is late, or the demand has taken over.
        """
        self._watch.request(step)
        self._speed = speed
        if self.on_demand or step < self._next_step:
            return None
        self._make_up(step)
        self._held_request = torque
        return self._advance(step)

    def tick(self, step: int, speed: float = 0.0) -> float | None:
        """Return the same at a tick, None as long as requests are waited for or obeyed."""
        if not (self._watch.tick(step) if self._watch.heard else self._watch.too_long(0, step)):
            return None
        if step >= self._next_step:
            self._speed = speed
            self._make_up(step)
            self._held_request = None
            self._advance(step)
        # A tick that comes again gets the same answer; an older one gets none.
        return self._torque if step == self._next_step - 1 else None

    def _make_up(self, step: int) -> None:
        for missed in steps_to_make_up(self._next_step, step):
            self._deliver(missed)
        self._next_step = step

    def _advance(self, step: int) -> float:
        self._next_step = step + 1
        self._torque = self._deliver(step)
        return self._torque

    def _deliver(self, step: int) -> float:
        demand = self._engine.demand(step)
        request = demand if self._held_request is None else self._held_request
        return self._engine.torque(step, request, self._speed)
