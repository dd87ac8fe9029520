"""The engine's share of two-input control, and what the clutch takes over beyond it."""

from ddct_controllers.interface import Measurement
from ddct_controllers.state_of_art.parts.pid import Pid
from ddct_controllers.state_of_art.parts.rigid_transmission import RigidTransmission
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import EngineAuthority, EngineResponse

TAKEOVER_BANDWIDTH_RAD_S = 5.0
"""Crossover of the slip loop through the clutch, whose 43 ms then cost it 12 degrees."""
NEGLIGIBLE_RAD_S2 = 1e-6


class EngineShare:
    """
    An engine that moves the slip as a PID asks, as far as its authority goes.

    Beyond it the slip would run away. Then `lacking`, the slip acceleration that was asked for and
    cannot be had, goes to the clutch through a PI: with the PID's anti-windup it is K_p times the
    slip error, and C_f = -(w/(g K_p)) (1 + w/(4 s)) lacking, g = 1/J_m + 1/J_eq, makes a slip loop
    of crossover w. A lag of the engine is not counted as lacking.
    """

    def __init__(
        self, transmission: RigidTransmission, authority: EngineAuthority, bandwidth_rad_s: float
    ) -> None:
        """Take the bandwidth of the PID that acts on the slip; start on the demand."""
        self._transmission = transmission
        self._authority = authority
        self._pid = pid = Pid(bandwidth_rad_s, authority.lag_s)
        proportional = TAKEOVER_BANDWIDTH_RAD_S / (transmission.slip_gain * pid.proportional)
        self._proportional = proportional
        self._integral_gain = proportional * TAKEOVER_BANDWIDTH_RAD_S / 4.0
        self._share = PERIOD_S / (PERIOD_S + pid.derivative / pid.proportional)
        self.reset()

    def reset(self) -> None:
        """Return to the demand."""
        self._response = EngineResponse(self._authority)
        self._pid.reset()
        self._lacking = 0.0
        self._taken_over = 0.0

    @property
    def at_its_limit(self) -> bool:
        """Whether the last request was beyond the engine's authority."""
        return abs(self._lacking) > NEGLIGIBLE_RAD_S2

    @property
    def clutch_torque(self) -> float:
        """What the clutch transmits more in its place, in N m."""
        return -self._proportional * self._lacking - self._taken_over

    def hold(self, measurement: Measurement) -> float:
        """Return C_m in N m over a period in which the demand is asked for."""
        return self._response.deliver(measurement.engine_torque, measurement.engine_torque)

    def update(
        self,
        measurement: Measurement,
        clutch_torque: float,
        slip_error: float,
        slip_rate: float,
    ) -> tuple[float, float]:
        """
        Return the C_m to ask for and the C_m that comes, in N m over the coming period.

        The slip shall have the rate `slip_rate` in rad/s^2 and lose the error in rad/s, with
        `clutch_torque` N m transmitted.
        """
        rate = slip_rate + self._pid.update(slip_error)
        request = self._transmission.engine_torque(measurement, clutch_torque, rate)
        demand, limits = measurement.engine_torque, self._authority
        delivered = self._response.deliver(demand, request)
        reachable = demand + self._response.asked
        reachable = min(max(reachable, limits.minimum_torque_n_m), limits.maximum_torque_n_m)
        lacking = (request - reachable) / self._transmission.engine_inertia
        self._pid.unwind(lacking)
        self._lacking += self._share * (lacking - self._lacking)
        self._taken_over += self._integral_gain * PERIOD_S * self._lacking
        return request, delivered
