# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Timeout of requests, and the ramp to an open clutch, of a run in real time."""

import math
from dataclasses import dataclass

from ddct_plant.base.options import OptionGroup, option
from ddct_plant.base.timebase import PERIOD_NS, PERIOD_S

REQUEST_TIMEOUT_S = 0.05
"""Default timeout in s of a missing request."""
MOST_REQUEST_TIMEOUT_S = 10.0
"""Largest timeout in s that may be chosen."""
CLUTCH_TIMEOUT_S = 0.1
"""Default timeout in s of a missing clutch torque, above that of the actuator's requests, so that
the actuator's fail-safe comes first."""
MOST_CATCH_UP_STEPS = round(MOST_REQUEST_TIMEOUT_S / PERIOD_S)
"""Largest number of steps without a request that are computed afterwards: the longest hold."""


@dataclass(frozen=True)
class FailSafeSettings(OptionGroup):
    """Timeout of requests, and rate at which the clutch then opens."""

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


class RequestWatch:
    """
    Detect that requests have stopped for longer than the timeout in s.

    Later requests are ignored until the node is started again.
    """

    def __init__(self, timeout_s: float) -> None:
        # Stamps are whole ns, so the timeout is too: in floats some trip a step early.
        self._timeout_ns = round(timeout_s * 1e9)
        self._last_step: int | None = None
        self.stopped = False
        """Whether requests have stopped."""

    @property
    def received(self) -> bool:
        """Whether any request has been received."""
        return self._last_step is not None

    def request(self, step: int) -> None:
        """Note the request of `step`, which may be late."""
        self._last_step = step if self._last_step is None else max(step, self._last_step)

    def tick(self, step: int) -> bool:
        """Return at the start of `step` whether requests have stopped."""
        if self._last_step is not None and not self.stopped:
            self.stopped = self.too_long(self._last_step, step)
        return self.stopped

    def too_long(self, since_step: int, step: int) -> bool:
        """Return whether more than the timeout lies between two steps."""
        return (step - since_step) * PERIOD_NS > self._timeout_ns


class FailSafe(RequestWatch):
    """Watch of requests that ramps the last one to an open clutch when they stop."""

    def __init__(self, settings: FailSafeSettings) -> None:
        super().__init__(settings.request_timeout_s)
        self._most_change = settings.fail_safe_ramp_n_m_s * PERIOD_S
        self.torque = 0.0
        """Last request in N m, at which the ramp begins."""

    def next_torque(self, periods: int = 1) -> float:
        """Return the request in N m on the ramp to an open clutch, `periods` of 10 ms later."""
        left = max(abs(self.torque) - periods * self._most_change, 0.0)
        self.torque = math.copysign(left, self.torque)
        return self.torque
