# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Example of a third party's controller: proportional, with a dead zone and a preview."""

from collections.abc import Mapping
from typing import ClassVar

from ddct_controllers.interface import Command, Controller, ControllerContext, Measurement
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import Option, Options
from ddct_plant.base.units import rpm_from_rad_s


class DeadZoneController(Controller):
    """u = -K_p (e less a dead zone), e in rpm towards the reference of the next step, u in N m."""

    options: ClassVar[Options] = {
        'proportional_gain': Option(0.2, 'K_p', 'N m/rpm', at_least=0.0, live=True),
        'dead_zone_rpm': Option(5.0, 'half the width of the dead zone', 'rpm', at_least=0.0),
    }
    preview_steps = 1

    def __init__(self, context: ControllerContext) -> None:
        """Take the options, which are checked and whole."""
        self._gain = context.gains['proportional_gain']
        self._dead_zone_rpm = context.gains['dead_zone_rpm']

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
        self._gain = self.options[name].checked(name, value)
