"""The actuator with its fail-safe, on the grid of the ticks; knows nothing of ROS."""

from ddct_plant.fail_safe.request_watch import FailSafe, FailSafeSettings, steps_to_make_up
from ddct_plant.models.actuator import Actuator


class GuardedActuator:
    """
    The actuator as requests and ticks drive it.

    In lock-step only requests do. In real time, steps without a request hold the last one; when
    requests stop for longer than the timeout, the clutch opens and obeys no request any more.
    """

    def __init__(
        self, actuator: Actuator, initial_request: float, fail_safe: FailSafeSettings
    ) -> None:
        """Guard an actuator that is at rest on `initial_request` in N m."""
        self._actuator = actuator
        self._fail_safe = FailSafe(fail_safe)
        self._held_request = initial_request
        self._next_step = 0
        self._torques: list[float] = []

    @property
    def opening(self) -> bool:
        """Whether the fail-safe is opening the clutch, or has opened it."""
        return self._fail_safe.engaged

    def too_long(self, since_step: int, step: int) -> bool:
        """Say whether more than the request timeout lies between two steps."""
        return self._fail_safe.watch.too_long(since_step, step)

    def request(self, step: int, torque: float) -> list[float] | None:
        """
        Return the (11,) torques in N m over the period of `step`, for a request in N m.

        None where the request is not obeyed: it is late, or the fail-safe has taken over.
        """
        if self.opening or step < self._next_step:
            return None
        self._hold(step)
        self._fail_safe.request(step, torque)
        return self._advance(torque)

    def tick(self, step: int) -> list[float] | None:
        """Return the same at a tick, None as long as requests are waited for or obeyed."""
        ramping = self.opening
        if not self._fail_safe.tick(step):
            return None
        if step >= self._next_step:
            if ramping:
                self._ramp(step)
            else:
                self._hold(step)
            self._advance(self._fail_safe.next_torque())
        # A tick that comes again gets the same answer; an older one gets none.
        return self._torques if step == self._next_step - 1 else None

    def _hold(self, step: int) -> None:
        for _ in steps_to_make_up(self._next_step, step):
            self._actuator.update(self._held_request)
        self._next_step = step

    def _ramp(self, step: int) -> None:
        missed = steps_to_make_up(self._next_step, step)
        self._fail_safe.next_torque(step - self._next_step - len(missed))
        for _ in missed:
            self._actuator.update(self._fail_safe.next_torque())
        self._next_step = step

    def _advance(self, request: float) -> list[float]:
        self._next_step += 1
        self._held_request = request
        self._torques = self._actuator.update(request)
        return self._torques
