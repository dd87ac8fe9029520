"""The preliminary PI controller that the thesis compares against (Section 1.4.5.1)."""

from collections.abc import Mapping

import numpy as np

from ddct_controllers.interface import THESIS, Command, Controller, ControllerSpec, Measurement
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import REQUIRED, Option
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace

OPTIONS = {
    'proportional_gain': Option(
        REQUIRED, 'K_p: torque per slip error', 'N m/rpm', at_least=0.0, at_most=1e3, live=True
    ),
    'integral_gain': Option(
        REQUIRED,
        'K_i: torque per slip error and second',
        'N m/(rpm s)',
        at_least=0.0,
        at_most=1e3,
        live=True,
    ),
}


class PiController(Controller):
    """
    u = -(K_p e + K_i integral of e) with e in rpm and u in N m.

    G_c(s) = -(K_p + K_i/s) by zero-order hold. The thesis prints no gains: those of its scenario
    are calibrated.
    """

    def __init__(self, proportional_gain: float, integral_gain: float) -> None:
        """Take K_p in N m/rpm and K_i in N m/(rpm s), neither negative."""
        self._gains: dict[str, float] = {}
        self.set_gain('proportional_gain', proportional_gain)
        self.set_gain('integral_gain', integral_gain)
        self._integral_rpm_s = 0.0

    def reset(self) -> None:
        """Empty the integral."""
        self._integral_rpm_s = 0.0

    def update(self, measurement: Measurement) -> Command:
        """Return the torque of this period; the integral takes the error in afterwards."""
        error_rpm = measurement.slip_error_rpm
        torque = -(
            self._gains['proportional_gain'] * error_rpm
            + self._gains['integral_gain'] * self._integral_rpm_s
        )
        self._integral_rpm_s += PERIOD_S * error_rpm
        return Command(torque)

    def linear_model(self) -> StateSpace:
        """Return -(K_p + K_i T / (z - 1)); its state is the integral of the error."""
        proportional, integral = (np.array([[-self._gains[name]]]) for name in OPTIONS)
        one = np.ones((1, 1))
        return StateSpace(one, PERIOD_S * one, integral, proportional, PERIOD_S)

    def gains(self) -> Mapping[str, float]:
        """Return K_p and K_i."""
        return dict(self._gains)

    def set_gain(self, name: str, value: float) -> None:
        """Change K_p or K_i from the next update on; the integral of the error is kept."""
        if name not in OPTIONS:
            raise ParameterError(f'pi has no gain {name!r}: it has {", ".join(OPTIONS)}')
        self._gains[name] = OPTIONS[name].checked(f'controllers.pi.{name}', value)


PI = ControllerSpec('pi', lambda context: PiController(**context.gains), OPTIONS, THESIS)
