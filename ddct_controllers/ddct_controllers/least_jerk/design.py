# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Numbers of `least_jerk` that its scenario and options give, constant over a run."""

import math
from dataclasses import dataclass

from ddct_controllers.interface import ControllerContext
from ddct_controllers.least_jerk.engine_guard import EngineGuard, SpeedRange
from ddct_controllers.least_jerk.lock import LockPhases
from ddct_controllers.least_jerk.options import LeastJerkOptions
from ddct_controllers.least_jerk.plan import PlanLimits
from ddct_controllers.least_jerk.shaped_demand import shaping_steps, starts_locked
from ddct_controllers.least_jerk.slip_estimate import RigidSlip, twist_of
from ddct_controllers.least_jerk.torque_covariance import TorqueNoise
from ddct_controllers.least_jerk.torque_estimate import (
    APPLIED_SHARE,
    APPLIED_SHARE_IN_SHIFTS,
    CarriedTorque,
)
from ddct_plant.base.clutch_kinds import LINEAR
from ddct_plant.base.options import with_values
from ddct_plant.models.actuator import ActuatorParameters
from ddct_plant.models.clutch import FrictionParameters
from ddct_plant.models.engine import EngineAuthority
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.initial_state import initial_request

MOST_SHARE = 0.97
"""Highest torque of plates that slip over what the clutch carries, before it is rounded up."""


@dataclass(frozen=True)
class LeastJerkDesign:
    """What the controller is computed from."""

    options: LeastJerkOptions
    driveline: DrivelineParameters
    static: StaticTorque
    """Torque of constant slip."""
    limits: PlanLimits
    speeds: SpeedRange
    most_torque: float
    """Highest torque in N m of plates that slip."""
    most_request: float
    """Highest request in N m of closed plates, that of a closing stage."""
    sticks: bool
    """Whether the plates can lock."""
    shifts: bool
    """Whether the run is a gear shift."""
    actuator: ActuatorParameters
    """Known actuator, whose lag the plan compensates."""
    initial_request: float
    """Request in N m before the first measurement."""
    authority: EngineAuthority
    """Authority over the engine torque."""
    shaping_steps: int
    """Number of steps over which C_m follows the demand; 0 where the driver has the engine."""

    @classmethod
    def of(cls, context: ControllerContext) -> 'LeastJerkDesign':
        """Return the design for a run; raise ParameterError for an option out of its range."""
        settings, scenario = context.settings, context.settings.scenario
        options = with_values(LeastJerkOptions(), context.gains)
        driveline, sticks = scenario.controlled_driveline, settings.clutch != LINEAR
        # Rate of the torque in N m/s at the jerk of `jerk_m_s3` of a rigid car.
        wheel_torque = driveline.vehicle_inertia / scenario.vehicle.wheel_radius_m
        limits = PlanLimits(
            easy_rate=options.jerk_m_s3 * driveline.gear.shaft_torque(wheel_torque),
            refill_per_s=1.0 / options.refill_s if settings.shift else 0.0,
            latest_s=options.latest_s,
            least_s=options.shift_s if settings.shift else options.least_s,
            bandwidth_rad_s=options.bandwidth_rad_s,
            end_s=options.end_s,
            twist=twist_of(driveline),
            smoothing_s=options.smoothing_s,
            sticks=sticks,
            hurries=not sticks or starts_locked(settings),
        )
        return cls(
            options=options,
            driveline=driveline,
            static=StaticTorque(driveline, scenario.equilibrium),
            limits=limits,
            speeds=SpeedRange.of(options.least_speed_rad_s, scenario.engine_limits),
            most_torque=most_slipping_torque(options.most_torque_n_m, scenario.friction),
            most_request=scenario.friction.worn_request,
            sticks=sticks,
            shifts=bool(settings.shift),
            actuator=scenario.actuator,
            initial_request=initial_request(settings),
            authority=scenario.engine_authority,
            shaping_steps=shaping_steps(driveline, options.demand_periods)
            if starts_locked(settings)
            else 0,
        )

    def clutch(self) -> CarriedTorque:
        """Return the estimate of the carried torque."""
        options, p = self.options, self.driveline
        return CarriedTorque(
            p.engine_inertia,
            p.engine_damping,
            TorqueNoise(options.gain_drift, options.offset_drift_n_m),
            self.applied_share,
        )

    @property
    def applied_share(self) -> float:
        """Share with which requests follow that estimate."""
        return APPLIED_SHARE_IN_SHIFTS if self.shifts else APPLIED_SHARE

    def slip(self) -> RigidSlip:
        """Return the observer of the slip."""
        return RigidSlip(self.driveline, self.options.observer_rad_s)

    def guard(self) -> EngineGuard:
        """Return the guard of the engine speed."""
        return EngineGuard(self.driveline, self.speeds, self.options.guard_s, self.most_torque)

    def lock(self) -> LockPhases:
        """Return the phases of the lock."""
        return LockPhases(self.most_request)


def most_slipping_torque(given: float | None, friction: FrictionParameters) -> float:
    """Return the highest torque of plates that slip in N m: `MOST_SHARE` if none is given."""
    return math.ceil(MOST_SHARE * friction.most_n_m) if given is None else given
