# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The handovers `timed`, `model` and `slip`, and the list of ours."""

from collections.abc import Callable, Mapping

from ddct_controllers.handover.adaptive import AdaptiveHandover
from ddct_controllers.handover.interface import (
    Handover,
    HandoverCommand,
    HandoverMeasurement,
    HandoverModel,
)
from ddct_controllers.handover.third_party import third_party_handover
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.rules.shift import shift_of
from ddct_plant.scenario.settings import KnownSettings, require_known

PROPORTIONAL, INTEGRAL = 0.0516, 0.044376
"""
Gains of the handover `slip` over J_m/L and J_m/L^2, with the lag L of the actuator.

A torque C changes the slip of the engine at C/J_m, so the lag costs this loop the same phase in
every car. The torque of a slipping clutch does not damp the driveshaft: more proportional gain
amplifies its oscillation.
"""
SEARCH_FROM, SEARCH_FALL = 0.1, 0.0645
"""
Start of the search for slip above the balance, and its fall in a lag, as shares of the balance.
"""
FOUND = 0.2
"""Slip from which the clutch counts as slipping, as a share of `shift.handover_slip_rad_s`."""
LEAST_SHARE = -0.5
"""Share at which the search ends: a clutch that does not slip by then hands over all the same."""


class TimedHandover(Handover):
    """
    Both clutches follow ramps of time, without a measurement.

    The share rises, and the off-going request falls from its value at the start to zero, over
    `shift.handover_s`. The actuators delay both alike.
    """

    def __init__(self, settings: KnownSettings) -> None:
        """Start locked."""
        super().__init__(settings)
        self._model = HandoverModel(settings)
        self._first_request = 0.0

    def update(self, measurement: HandoverMeasurement) -> HandoverCommand:
        """Return the command for the period of t_k."""
        elapsed = measurement.step - self._model.start_step
        if elapsed >= self._model.steps:
            return self._model.inertia_phase(measurement)
        if elapsed <= 0:
            command = self._model.locked(measurement)
            self._first_request = command.off_going_request
            return command
        share = elapsed / self._model.steps
        return HandoverCommand(share, (1.0 - share) * self._first_request, 0.0)


class ModelHandover(Handover):
    """
    The off-going clutch follows the torque balance of the rigid car.

    The share rises over `shift.handover_s`. The off-going request is what that clutch carries
    while the on-coming one carries its share of C_fOL, times a margin, so that it sticks until its
    torque is gone. Both requests pass the same actuator, so that its lag delays both torques alike
    and the balance holds between the clutches.
    """

    def __init__(self, settings: KnownSettings) -> None:
        """Start locked."""
        super().__init__(settings)
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
        return HandoverCommand(share, self._model.off_going_request(measurement, on_coming), 0.0)


class SlipHandover(Handover):
    """
    The off-going clutch slips a little, under feedback, until it carries nothing.

    First its request falls along a ramp until it slips: what the clutch carries differs from the
    balance, as it is worn or hot. Then the share rises over `shift.handover_s`, and the request is
    that of the balance, plus the difference found, plus PI feedback of the slip about
    `shift.handover_slip_rad_s`. Where the request reaches zero, or the share 1, the torque is
    gone, and the clutch opens. This follows Goetz (Integrated Powertrain Control for Twin Clutch
    Transmissions, University of Leeds, 2005), who transfers the torque under control of clutch
    slip: a clutch that slips forward cannot brake the car. Law and gains are our own.
    """

    def __init__(self, settings: KnownSettings) -> None:
        """Start locked."""
        super().__init__(settings)
        self._model = HandoverModel(settings)
        self._target = shift_of(settings.scenario).handover_slip_rad_s
        scenario = settings.scenario
        engine_inertia = scenario.driveline.engine_inertia
        lag_ms = round(1e3 * scenario.actuator.lag_s)
        self._proportional = 1e3 * PROPORTIONAL / lag_ms * engine_inertia
        self._integral_per_step = 1e6 * INTEGRAL / lag_ms**2 * engine_inertia * PERIOD_S
        self._search_rate = 1e3 * SEARCH_FALL / lag_ms
        self._difference: float | None = None
        """Request less the balance in N m that the slip needs; None until the clutch slips."""
        self._rise_steps = 0
        self._open = False

    def update(self, measurement: HandoverMeasurement) -> HandoverCommand:
        """Return the command for the period of t_k."""
        elapsed = measurement.step - self._model.start_step
        if elapsed <= 0:
            return self._model.locked(measurement)
        if self._difference is None:
            carried = self._model.off_going(measurement)
            share = SEARCH_FROM - self._search_rate * PERIOD_S * elapsed
            slips = measurement.off_going_slip >= FOUND * self._target
            if not slips and share >= LEAST_SHARE:
                return HandoverCommand(0.0, max((1.0 + share) * carried, 0.0), 0.0)
            # It slips by the torque of what was requested a lag before.
            self._difference = (share + SEARCH_FALL) * carried
        self._rise_steps += 1
        share = min(self._rise_steps / self._model.steps, 1.0)
        request = 0.0 if self._open else self._request(measurement, share)
        self._open = request <= 0.0
        if share == 1.0:
            return self._model.inertia_phase(measurement)
        return HandoverCommand(share, max(request, 0.0), 0.0)

    def _request(self, now: HandoverMeasurement, share: float) -> float:
        """Return the off-going request in N m before it is cut off below zero."""
        assert self._difference is not None
        carried = self._model.off_going(now, share * self._model.on_coming(now))
        error = now.off_going_slip - self._target
        self._difference += self._integral_per_step * error
        return carried + self._difference + self._proportional * error


HANDOVERS: Mapping[str, Callable[[KnownSettings], Handover]] = {
    'timed': TimedHandover,
    'slip': SlipHandover,
    'model': ModelHandover,
    'adaptive': AdaptiveHandover,
}
"""Handovers by name."""


def make_handover(settings: KnownSettings) -> Handover:
    """
    Return the handover of a run, from its known settings: one of ours by name, or a third party's.

    Raise ParameterError for an unknown name and for other settings, DdctError for code of others
    that fails.
    """
    require_known(settings)
    made = HANDOVERS.get(settings.handover)
    return made(settings) if made else third_party_handover(settings, HANDOVERS)
