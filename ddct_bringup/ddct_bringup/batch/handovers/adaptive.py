# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The handover `adaptive` of many shifts at once."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.handovers.laws import StackedHandover
from ddct_bringup.batch.handovers.on_coming_estimates import OnComingEstimates
from ddct_bringup.batch.plant.actuators import Actuators
from ddct_bringup.batch.plant.engines import LimitedEngines
from ddct_controllers.handover.adaptive import RESERVE, RESERVE_FADES_S, SLIPS_RAD_S
from ddct_controllers.handover.interface import HandoverCommand, HandoverMeasurement
from ddct_controllers.handover.on_coming_estimate import OnComingModel
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import KnownSettings
from ddct_plant.shift.balance import OnComingShare


class AdaptiveHandovers(StackedHandover):
    """The counterpart of `AdaptiveHandover`; either all engines have limits or none."""

    def __init__(self, runs: Sequence[KnownSettings]) -> None:
        """Start locked."""
        super().__init__(runs)
        scenarios = [run.scenario for run in runs]
        delays = [_delays(run) for run in runs]
        self._estimates = OnComingEstimates(
            [
                OnComingModel.of(gears_of(scenario), *each)
                for scenario, each in zip(scenarios, delays, strict=True)
            ]
        )
        actuators = [each.actuator for each in scenarios]
        last = self.model.start_step + int(self.model.steps.max())
        self._actuators, self._periods = Actuators(actuators, np.zeros(len(runs)), last), 0
        self._first_step = np.array([math.ceil(max(each) / PERIOD_S) for each in delays])
        limits = [each.engine_limits for each in scenarios if each.engine_limits]
        self._engines = LimitedEngines(limits) if limits else None
        self._wheel_radius = np.array([each.vehicle.wheel_radius_m for each in scenarios])
        none: Any = np.zeros(len(runs))
        self._demand = self._load = self._request = none
        self._wear_deviation = self._torque_offset = none

    def update(self, now: HandoverMeasurement, load_torque: np.ndarray) -> HandoverCommand:
        """Return the commands for the period of t_k."""
        if self._engines:
            # At full load the engine gives less than demanded, which would look like wear.
            demanded: Any = (now.demand, now.engine_speed)
            given: Any = self._engines.deliver(*demanded)
            now = now._replace(demand=given)
        measuring = now.step - self.model.start_step <= self.model.steps
        if measuring.any():
            self._measure(now, load_torque, measuring & (now.step >= self._first_step))
        return super().update(now, load_torque)

    def since_start(
        self, now: HandoverMeasurement, load_torque: np.ndarray, elapsed: int
    ) -> HandoverCommand:
        """Return the commands `elapsed` periods after the start of the shift."""
        share = self.share(elapsed)
        requested = self._with_reserve(share, elapsed)
        on_coming = share * self.model.on_coming(now, load_torque)
        self._request = requested.request(on_coming)
        request = self.model.off_going_request(now, load_torque, on_coming)
        command = self.model.during_and_after(now, share, request)
        return command._replace(**requested._asdict())

    def _with_reserve(self, share: Any, elapsed: int) -> OnComingShare:
        """Return what requests are corrected by."""
        after_s = np.maximum(elapsed - self.model.steps, 0) * PERIOD_S
        reserve = RESERVE * np.maximum(1.0 - after_s / RESERVE_FADES_S, 0.0)
        deviation = (1.0 - reserve) * (1.0 + self._wear_deviation) - 1.0
        return OnComingShare(share, deviation, self._torque_offset)

    def _measure(
        self, now: HandoverMeasurement, load_torque: np.ndarray, measured: np.ndarray
    ) -> None:
        """Update the estimates in rows (R,) with the speeds after the period that has ended."""
        speeds: Any = now.engine_speed, now.vehicle_speed / self._wheel_radius
        started = now.step > self._first_step
        if started.any():
            request = np.where(started, self._request, 0.0)
            torque = self._actuators.mean_torque(self._periods, request)
            self._periods += 1
            self._estimates.predict(self._demand, self._load, torque)
            locked = np.abs(now.off_going_slip) < SLIPS_RAD_S
            self._estimates.correct(started & locked, *speeds)
        if not started.all():
            first: Any = (now.step == self._first_step, *speeds, now.demand)
            self._estimates.start(*first)
        self._demand, self._load = now.demand, load_torque
        gain, offset = self._estimates.wear_gain, self._estimates.offset
        self._wear_deviation = np.where(measured, gain - 1.0, self._wear_deviation)
        self._torque_offset = np.where(measured, offset, self._torque_offset)


def _delays(run: KnownSettings) -> tuple[float, float]:
    """Return the delays in s of the measured w_m and V_x."""
    sensors = run.scenario.sensors
    return (sensors.engine_speed.delay_s, sensors.vehicle_speed.delay_s) if sensors else (0.0, 0.0)
