"""Open the clutch when requests stop: what the actuator does in real time without a controller."""

from dataclasses import asdict, dataclass

from ddct_plant.checks import require_number
from ddct_plant.timebase import PERIOD_S


@dataclass(frozen=True)
class FailSafeSettings:
    """When and how fast the clutch opens."""

    request_timeout_s: float = 0.05
    """A missing request is held this long."""
    fail_safe_ramp_n_m_s: float = 1000.0
    """Rate at which the request then runs to zero, in N m/s."""

    def __post_init__(self) -> None:
        """Check both; raise ParameterError that names a bad one."""
        require_number('request_timeout_s', self.request_timeout_s, above=0.0, at_most=10.0)
        require_number('fail_safe_ramp_n_m_s', self.fail_safe_ramp_n_m_s, above=0.0, at_most=1e6)

    def info(self) -> dict[str, str]:
        """Return both as text for `run_info`."""
        return {name: repr(value) for name, value in asdict(self).items()}


class FailSafe:
    """
    Watch the requests and, when they stop, ramp the last one down to an open clutch.

    It stays engaged until the node is started again: a clutch that closes unasked is a hazard.
    """

    def __init__(self, settings: FailSafeSettings) -> None:
        self._settings = settings
        self._last_step: int | None = None
        self._torque = 0.0
        self.engaged = False

    def request(self, step: int, torque: float) -> None:
        """Note the request in N m that came for `step`."""
        self._last_step = step
        self._torque = max(torque, 0.0)

    def tick(self, step: int) -> bool:
        """Say at the start of `step` whether the fail-safe is engaged from now on."""
        if self._last_step is not None and not self.engaged:
            self.engaged = (step - self._last_step) * PERIOD_S > self._settings.request_timeout_s
        return self.engaged

    def next_torque(self) -> float:
        """Return the request in N m of the next period on the way to an open clutch."""
        self._torque = max(self._torque - self._settings.fail_safe_ramp_n_m_s * PERIOD_S, 0.0)
        return self._torque
