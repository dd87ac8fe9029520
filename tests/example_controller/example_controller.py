"""Example of a third party's controller: proportional, with a dead zone and a preview."""

from collections.abc import Mapping

from ddct_controllers.interface import Command, Controller, ControllerContext, Measurement
from ddct_plant.base.checks import require_number
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.units import rpm_from_rad_s


class DeadZoneController(Controller):
    """u = -K_p (e less a dead zone), e in rpm towards the reference of the next step, u in N m."""

    preview_steps = 1

    def __init__(self, proportional_gain: float = 0.2, dead_zone_rpm: float = 5.0) -> None:
        """Take K_p in N m/rpm and half the width of the dead zone."""
        self._gain = require_number('proportional_gain', proportional_gain, at_least=0.0)
        self._dead_zone_rpm = require_number('dead_zone_rpm', dead_zone_rpm, at_least=0.0)

    def reset(self) -> None:
        """Do nothing: this controller has no state."""

    def update(self, measurement: Measurement) -> Command:
        """Return the torque of this period, and whether the error was in the dead zone."""
        error_rpm = rpm_from_rad_s(measurement.slip_reference[1] - measurement.slip_speed)
        outside_rpm = max(abs(error_rpm) - self._dead_zone_rpm, 0.0)
        torque = -self._gain * (outside_rpm if error_rpm > 0.0 else -outside_rpm)
        return Command(torque, (('in_dead_zone', str(outside_rpm == 0.0).lower()),))

    def gains(self) -> Mapping[str, float]:
        """Return what may be changed while it runs."""
        return {'proportional_gain': self._gain}

    def set_gain(self, name: str, value: float) -> None:
        """Change the gain from the next update on."""
        if name != 'proportional_gain':
            raise ParameterError(f'dead_zone has no gain {name!r}: it has proportional_gain')
        self._gain = require_number('proportional_gain', value, at_least=0.0)


def make_dead_zone(context: ControllerContext) -> DeadZoneController:
    """Build it with the scenario's gains, if it has any for this controller."""
    unknown = set(context.gains) - {'proportional_gain', 'dead_zone_rpm'}
    if unknown:
        raise ParameterError(f'controllers.dead_zone.{min(unknown)} is not a gain of dead_zone')
    return DeadZoneController(**context.gains)
