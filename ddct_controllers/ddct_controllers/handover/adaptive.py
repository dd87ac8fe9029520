# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The handover `adaptive`, which measures what the on-coming clutch carries."""

import math

from ddct_controllers.handover.interface import (
    Handover,
    HandoverCommand,
    HandoverMeasurement,
    HandoverModel,
)
from ddct_controllers.handover.on_coming_estimate import OnComingEstimate, OnComingModel
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine_limits import LimitedEngine
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import KnownSettings
from ddct_plant.shift.balance import OnComingShare

SLIPS_RAD_S = 1.0
"""
Measured slip of the off-going clutch from which its speeds are not used.

It slips, or a sensor has lost a sample: the engine gains 1.5 to 3 rad/s in a period before a
shift. The noise of both speeds makes 0.2 rad/s.
"""
RESERVE = 0.08
"""
Share by which the on-coming clutch is to carry more than C_fOL while the other one opens.

The estimate is wrong by 2 to 6 %, and an engine that runs up costs more than one that is braked.
"""
RESERVE_FADES_S = 0.2
"""Time in s after the handover in which that share returns to zero."""


class AdaptiveHandover(Handover):
    """
    As `model`, with a share of C_fOL that the on-coming clutch really carries.

    A worn or hot clutch carries another torque than requested. While the off-going clutch sticks,
    that torque follows from the speeds: `OnComingEstimate`. The requests of the on-coming clutch
    are corrected by it, in the torque phase and from then on, with every controller. So the clutch
    carries C_fOL when the off-going one opens: the engine neither runs up nor is braked.
    """

    def __init__(self, settings: KnownSettings) -> None:
        """Start locked."""
        super().__init__(settings)
        self._model = HandoverModel(settings)
        sensors = settings.scenario.sensors
        speeds = (sensors.engine_speed, sensors.vehicle_speed) if sensors else ()
        delays = [speed.delay_s for speed in speeds] or [0.0, 0.0]
        model = OnComingModel.of(gears_of(settings.scenario), *delays)
        self._estimate = OnComingEstimate(model, settings.scenario.actuator)
        # Until then a late sensor has its first value.
        self._first_step = math.ceil(max(delays) / PERIOD_S)
        limits = settings.scenario.engine_limits
        self._engine = LimitedEngine(limits) if limits else None
        self._wheel_radius = settings.scenario.vehicle.wheel_radius_m
        self._on_coming = OnComingShare(0.0)
        self._torques: tuple[float, float] | None = None
        """C_m and C_load in N m of the period that has ended, None before the first."""
        self._request = 0.0

    def update(self, measurement: HandoverMeasurement) -> HandoverCommand:
        """Return the command for the period of t_k."""
        model = self._model
        if self._engine:
            # At full load the engine gives less than demanded, which would look like wear.
            speed = measurement.engine_speed
            given = self._engine.deliver(measurement.demand, speed)
            measurement = measurement._replace(demand=given)
        elapsed = measurement.step - model.start_step
        if elapsed <= model.steps:
            self._measure(measurement)
        share = min(max(elapsed / model.steps, 0.0), 1.0)
        if share == 0.0:
            return model.locked(measurement)
        self._on_coming = self._on_coming._replace(share=share)
        requested = self._with_reserve(max(elapsed - model.steps, 0) * PERIOD_S)
        if share == 1.0:
            return model.inertia_phase(measurement)._replace(**requested._asdict())
        on_coming = share * model.on_coming(measurement)
        self._request = requested.request(on_coming)
        request = model.off_going_request(measurement, on_coming)
        return HandoverCommand(share, request, 0.0, *requested[1:])

    def _with_reserve(self, after_s: float) -> OnComingShare:
        """Return what requests are corrected by, a time in s after the handover."""
        reserve = RESERVE * max(1.0 - after_s / RESERVE_FADES_S, 0.0)
        gain = 1.0 + self._on_coming.wear_deviation
        return self._on_coming._replace(wear_deviation=(1.0 - reserve) * gain - 1.0)

    def _measure(self, now: HandoverMeasurement) -> None:
        """Update the estimate with the speeds after the period that has ended."""
        if now.step < self._first_step:
            return
        wheel_speed = now.vehicle_speed / self._wheel_radius
        if self._torques is None:
            self._estimate.start(now.engine_speed, wheel_speed, now.demand)
        else:
            self._estimate.predict(self._torques, self._request)
            if abs(now.off_going_slip) < SLIPS_RAD_S:
                self._estimate.correct(now.engine_speed, wheel_speed)
        self._torques = now.demand, self._model.load(now)
        self._on_coming = self._on_coming._replace(
            wear_deviation=self._estimate.wear_gain - 1.0, torque_offset=self._estimate.offset
        )
