"""What actuator, engine and driveline do in real time when what they wait for stops coming."""

import math
from dataclasses import asdict, dataclass

from ddct_plant.base.options import OptionGroup, option
from ddct_plant.base.timebase import PERIOD_NS, PERIOD_S

REQUEST_TIMEOUT_S = 0.05
"""How long a missing request is waited for."""
MOST_REQUEST_TIMEOUT_S = 10.0
CLUTCH_TIMEOUT_S = 0.1
"""How long the driveline waits for a missing clutch torque: the actuator's fail-safe is first."""
MOST_CATCH_UP_STEPS = round(MOST_REQUEST_TIMEOUT_S / PERIOD_S)
"""Steps without a request that are made up for at most: none is held for longer."""


@dataclass(frozen=True)
class FailSafeSettings(OptionGroup):
    """When and how fast the clutch opens."""

    request_timeout_s: float = option(
        REQUEST_TIMEOUT_S,
        'Real time: a missing request is held this long',
        's',
        at_least=PERIOD_S,
        at_most=MOST_REQUEST_TIMEOUT_S,
    )
    fail_safe_ramp_n_m_s: float = option(
        1000.0,
        'Real time: rate at which the clutch opens in the safe state',
        'N m/s',
        above=0.0,
        at_most=1e6,
    )

    def info(self) -> dict[str, str]:
        """Return both as text for `run_info`."""
        return {name: repr(value) for name, value in asdict(self).items()}


class RequestWatch:
    """
    Notice that requests have stopped for longer than the timeout in s.

    It ignores later requests until the node is started again.
    """

    def __init__(self, timeout_s: float) -> None:
        # Stamps are whole ns, so the timeout is too: in floats some trip a step early.
        self._timeout_ns = round(timeout_s * 1e9)
        self._last_step: int | None = None
        self.stopped = False
        """Whether they have."""

    @property
    def heard(self) -> bool:
        """Whether there was a request at all."""
        return self._last_step is not None

    def request(self, step: int) -> None:
        """Note that a request came for `step`."""
        self._last_step = step

    def tick(self, step: int) -> bool:
        """Say at the start of `step` whether requests have stopped."""
        if self._last_step is not None and not self.stopped:
            self.stopped = self.too_long(self._last_step, step)
        return self.stopped

    def too_long(self, since_step: int, step: int) -> bool:
        """Say whether more than the timeout lies between two steps."""
        return (step - since_step) * PERIOD_NS > self._timeout_ns


class FailSafe(RequestWatch):
    """Watch the requests and, when they stop, ramp the last one down to an open clutch."""

    def __init__(self, settings: FailSafeSettings) -> None:
        super().__init__(settings.request_timeout_s)
        self._most_change = settings.fail_safe_ramp_n_m_s * PERIOD_S
        self.torque = 0.0
        """The last request in N m, from which the ramp begins."""

    def next_torque(self, periods: int = 1) -> float:
        """Return the request in N m on the way to an open clutch, so many periods later."""
        left = max(abs(self.torque) - periods * self._most_change, 0.0)
        self.torque = math.copysign(left, self.torque)
        return self.torque
