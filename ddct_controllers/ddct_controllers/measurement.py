# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The measurement of one step, and its check before a controller stores any of it."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ddct_plant.base.errors import DdctError
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.plant import Observation

MOST = 1e9
"""Largest size of a signal, in its SI unit; far beyond any vehicle."""
_UNITS = {
    'engine_speed': 'rad/s',
    'shaft_speed': 'rad/s',
    'wheel_speed': 'rad/s',
    'engine_torque': 'N m',
    'load_torque': 'N m',
    'open_loop_torque': 'N m',
    'slip_reference': 'rad/s',
    'slip_reference_rate': 'rad/s^2',
}


@dataclass(frozen=True, slots=True)
class Measurement:
    """
    All signals that a controller receives at step k, in SI units.

    The transmitted torque C_f, the load C_load and the driveshaft twist are not measured in a car
    and are not here.
    """

    step: int
    """Step k; scenario time is k x 10 ms."""
    engine_speed: float
    """Engine speed w_m in rad/s."""
    shaft_speed: float
    """Primary shaft speed w_p in rad/s."""
    wheel_speed: float
    """Wheel speed w_r in rad/s."""
    vehicle_speed: float
    """Vehicle speed V_x in m/s."""
    engine_torque: float
    """Engine torque C_m in N m over the coming period; the driver's demand if C_m is commanded."""
    slip_reference: Sequence[float]
    """
    Slip references in rad/s, (P + 1,).

    Entry i is i x 10 ms ahead, P the controller's `preview_steps`.
    """
    slip_reference_rate: Sequence[float]
    """Rates of the slip reference in rad/s^2, (P + 1,), at the same times."""
    load_torque: float = 0.0
    """Load torque C_load in N m of the known car, which the architecture computes from V_x."""
    open_loop_torque: float = 0.0
    """Torque in N m that the architecture adds to the controller's clutch torque."""

    @classmethod
    def of_plant(
        cls,
        observation: Observation,
        slip_reference: Sequence[float],
        slip_reference_rate: Sequence[float],
    ) -> 'Measurement':
        """Return the measured signals of a plant, with the reference of that step."""
        measured = observation.tick.measured
        return cls(
            step=observation.tick.step,
            engine_speed=measured.engine_speed,
            shaft_speed=measured.shaft_speed,
            wheel_speed=measured.wheel_speed,
            vehicle_speed=measured.vehicle_speed,
            engine_torque=observation.engine_torque,
            slip_reference=slip_reference,
            slip_reference_rate=slip_reference_rate,
        )

    @property
    def slip_speed(self) -> float:
        """Slip speed w_d = w_m - w_p in rad/s."""
        return self.engine_speed - self.shaft_speed

    @property
    def slip_error_rpm(self) -> float:
        """Slip reference less slip speed in rpm, the input of the thesis's controllers."""
        return rpm_from_rad_s(self.slip_reference[0] - self.slip_speed)

    def within(
        self, load_torque: float, open_loop_torque: float, engine_torque: float | None = None
    ) -> 'Measurement':
        """
        Return the measurement completed with the architecture's two torques, in N m.

        `engine_torque` in N m takes the place of the measured one.
        """
        # dataclasses.replace takes three times as long, at every step of every controller.
        return Measurement(
            self.step,
            self.engine_speed,
            self.shaft_speed,
            self.wheel_speed,
            self.vehicle_speed,
            self.engine_torque if engine_torque is None else engine_torque,
            tuple(self.slip_reference),  # a copy: a controller may not change the record
            tuple(self.slip_reference_rate),
            load_torque,
            open_loop_torque,
        )


def measured_speeds(measurement: Measurement) -> tuple[float, float, float]:
    """
    Return w_m, w_p, w_r in rad/s after a check of the whole measurement.

    Raise DdctError that names the first number that is not finite or larger than MOST, among them,
    the torques and the references.
    """
    speeds = (measurement.engine_speed, measurement.shaft_speed, measurement.wheel_speed)
    # One call at every step: what is within MOST together is so each by itself.
    together = math.hypot(
        *speeds,
        measurement.engine_torque,
        measurement.load_torque,
        measurement.open_loop_torque,
        *measurement.slip_reference,
        *measurement.slip_reference_rate,
    )
    if not together <= MOST:
        _require_each(measurement)
    return speeds


def _require_each(measurement: Measurement) -> None:
    for name, unit in _UNITS.items():
        values = getattr(measurement, name)
        listed = isinstance(values, Iterable)
        for ahead, value in enumerate(values if listed else (values,)):
            if not abs(value) <= MOST:
                what = f'{name}[{ahead}]' if listed else name
                raise DdctError(
                    f'{what} is {value:g} {unit} at step {measurement.step}, not a number within '
                    f'+-{MOST:g}: mend what gives it, or the loop if it diverges',
                    key=what,
                )
