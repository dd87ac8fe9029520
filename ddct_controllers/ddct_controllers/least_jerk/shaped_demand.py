# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An engine torque that follows the driver's demand without exciting the locked driveline."""

import math
from dataclasses import replace

from ddct_controllers.interface import Measurement
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.driveline import LOCKED
from ddct_plant.models.engine import EngineAuthority, EngineResponse
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.settings import KnownSettings

WAIT_STEPS = 60
"""Number of steps for which a demand waits for plates that are not closed."""


def starts_locked(settings: KnownSettings) -> bool:
    """Return whether a run begins with locked plates, and so without an engagement."""
    locked = settings.scenario.initial.clutch_phase == LOCKED
    return settings.stick_slip and not settings.shift and locked


def shaping_steps(driveline: DrivelineParameters, periods: float) -> int:
    """
    Return how many steps a number of periods of the locked driveline's oscillation are.

    Engine and car turn against each other on the half-shafts: with g = 1/(J_m + J_p) + tau^2/J_v,
    s^2 + g (c_sa/tau^2) s + g k_sa/tau^2 = 0. Where it is overdamped there are none.
    """
    p, at_shaft = driveline, driveline.gear.at_shaft
    per_inertia = 1.0 / (p.engine_inertia + p.shaft_inertia) + 1.0 / at_shaft(p.vehicle_inertia)
    decay = 0.5 * per_inertia * at_shaft(p.halfshaft_damping)
    squared = per_inertia * at_shaft(p.halfshaft_stiffness) - decay * decay
    return round(periods * math.tau / math.sqrt(squared) / PERIOD_S) if squared > 0.0 else 0


class ShapedDemand:
    """
    The mean of the demands of the last steps, within the authority over the engine.

    A mean over a period of an oscillation does not excite it: the parts of its step response half
    a period apart cancel (Singer and Seering, 1990). So the twist of the half-shafts does not
    overshoot, and locked plates carry no more than the demand needs. Until the plates
    are closed a change of the demand waits, for up to `WAIT_STEPS`.
    """

    def __init__(self, steps: int, authority: EngineAuthority) -> None:
        """Take the number of steps; none leaves the engine to the driver."""
        self._authority = authority
        self.steps = steps
        self.reset()

    def reset(self) -> None:
        """Return to an engine that gives no torque."""
        self._response = EngineResponse(self._authority)
        self.hold(0.0)

    def hold(self, demand: float) -> None:
        """Take the engine as giving the demand in N m, now and before."""
        self._demands = [demand] * self.steps
        self._mean = self._last = demand
        self._next = self._waited = 0
        self._response.deliver(demand, demand)

    def update(
        self, measurement: Measurement, *, closed: bool
    ) -> tuple[Measurement, float | None]:
        """Return the measurement with the C_m of the coming period, and its request in N m."""
        if not self.steps:
            return measurement, None
        self._waited = 0 if closed else self._waited + 1
        if not 0 < self._waited <= WAIT_STEPS:
            self._last = measurement.engine_torque
        self._mean += (self._last - self._demands[self._next]) / self.steps
        self._demands[self._next] = self._last
        self._next = (self._next + 1) % self.steps
        delivered = self._response.deliver(measurement.engine_torque, self._mean)
        return replace(measurement, engine_torque=delivered), self._mean
