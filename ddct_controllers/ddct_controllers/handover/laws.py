# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The handovers `timed`, `model` and `slip`."""

from collections.abc import Callable, Mapping

from ddct_controllers.handover.interface import (
    Handover,
    HandoverCommand,
    HandoverMeasurement,
    HandoverModel,
)
from ddct_plant.base.errors import require_choice
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.scenario.shift_rules import shift_of

MARGIN = 1.1
"""Request of the off-going clutch over the torque that it carries, in the handover `model`."""
PROPORTIONAL, INTEGRAL = 0.8, 2.0
"""
Gains of the handover `slip` in N m s/rad and N m/rad.

A torque of 1 N m changes the slip of an engine of 0.25 kg m^2 by 4 rad/s^2. So the loop crosses
over at 3 rad/s, where the lag of the actuator, 43 ms, costs 8 degrees of phase. Higher gains
overshoot more, as the request falls before the clutch slips.
"""
PATIENCE_STEPS = 30
"""Longest wait for the slip in periods: a clutch that does not slip hands over all the same."""


class TimedHandover:
    """
    Both clutches follow ramps of time, without a measurement.

    The share rises, and the off-going request falls from its value at the start to zero, over
    `shift.handover_s`. The actuators delay both alike.
    """

    def __init__(self, settings: RunSettings) -> None:
        """Start locked."""
        self._model = HandoverModel(settings)
        self._from = 0.0

    def update(self, measurement: HandoverMeasurement) -> HandoverCommand:
        """Return the command for the period of t_k."""
        elapsed = measurement.step - self._model.start_step
        if elapsed >= self._model.steps:
            return self._model.inertia_phase(measurement)
        if elapsed <= 0:
            command = self._model.locked(measurement)
            self._from = command.off_going_request
            return command
        share = elapsed / self._model.steps
        return HandoverCommand(share, (1.0 - share) * self._from, 0.0)


class ModelHandover:
    """
    The off-going clutch follows the torque balance of the rigid car.

    The share rises over `shift.handover_s`. The off-going request is what that clutch carries
    while the on-coming one carries its share of C_fOL, times a margin, so that it sticks until its
    torque is gone. Both requests pass the same actuator, so that its lag delays both torques alike
    and the balance holds between the clutches.
    """

    def __init__(self, settings: RunSettings) -> None:
        """Start locked."""
        self._model = HandoverModel(settings)

    def update(self, measurement: HandoverMeasurement) -> HandoverCommand:
        """Return the command for the period of t_k."""
        elapsed = measurement.step - self._model.start_step
        if elapsed >= self._model.steps:
            return self._model.inertia_phase(measurement)
        if elapsed <= 0:
            return self._model.locked(measurement)
        share = elapsed / self._model.steps
        on_coming = share * self._model.on_coming(measurement)
        carried = self._model.off_going(measurement, on_coming)
        return HandoverCommand(share, MARGIN * max(carried, 0.0), 0.0)


class SlipHandover:
    """
    The off-going clutch slips a little, under feedback, until it carries nothing.

    Its request is that of the torque balance, plus PI feedback of its slip about
    `shift.handover_slip_rad_s`. The share rises over `shift.handover_s` once the clutch slips.
    Where the request reaches zero, or the share 1, the torque is gone, and the clutch opens. This
    follows Goetz (Integrated Powertrain Control for Twin Clutch Transmissions, University of
    Leeds, 2005), who transfers the torque under control of clutch slip: a clutch that slips
    forward cannot brake the car. Law and gains are our own.
    """

    def __init__(self, settings: RunSettings) -> None:
        """Start locked."""
        self._model = HandoverModel(settings)
        self._target = shift_of(settings.scenario).handover_slip_rad_s
        self._integral = 0.0
        self._rising = 0
        self._over = False

    def update(self, measurement: HandoverMeasurement) -> HandoverCommand:
        """Return the command for the period of t_k."""
        elapsed = measurement.step - self._model.start_step
        if elapsed <= 0:
            return self._model.locked(measurement)
        if not self._over:
            slips = measurement.off_going_slip >= self._target / 2.0
            if self._rising or slips or elapsed > PATIENCE_STEPS:
                self._rising += 1
            share = min(self._rising / self._model.steps, 1.0)
            request = self._request(measurement, share)
            self._over = share == 1.0 or (self._rising > 0 and request <= 0.0)
            if not self._over:
                return HandoverCommand(share, max(request, 0.0), 0.0)
        return self._model.inertia_phase(measurement)

    def _request(self, now: HandoverMeasurement, share: float) -> float:
        """Return the off-going request in N m before it is cut off below zero."""
        carried = self._model.off_going(now, share * self._model.on_coming(now))
        error = now.off_going_slip - self._target
        self._integral += INTEGRAL * PERIOD_S * error
        return carried + PROPORTIONAL * error + self._integral


HANDOVERS: Mapping[str, Callable[[RunSettings], Handover]] = {
    'timed': TimedHandover,
    'slip': SlipHandover,
    'model': ModelHandover,
}
"""Handovers by name."""


def make_handover(settings: RunSettings) -> Handover:
    """Return the handover of a run; raise ParameterError for an unknown name."""
    require_choice('handover', settings.handover, tuple(HANDOVERS))
    return HANDOVERS[settings.handover](settings)
