# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Parameters of the plant that metrics and limits use besides the signals of a run."""

from dataclasses import dataclass

from ddct_plant.models.clutch import FrictionParameters
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.scenario import Scenario


@dataclass(frozen=True)
class JudgedPlant:
    """Inertias and gear of the simulated car, in SI units."""

    engine_inertia: float
    """Engine inertia J_m in kg m^2."""
    rest_inertia: float
    """Inertia J_eq = J_p + J_v/tau^2 in kg m^2 of the rigid car at the primary shaft."""
    gear: EngagedGear
    """Engaged gear between primary shaft and wheels."""
    mass: float
    """Vehicle mass m_v in kg."""
    wheel_radius: float
    """Wheel radius r_w in m."""
    gravity: float
    """Gravitational acceleration g in m/s^2."""
    engine_side_inertia: float
    """Inertia J_m + J_p in kg m^2 of a locked clutch on the engine's side of the half-shafts."""
    vehicle_inertia: float
    """Inertia J_v of the vehicle at the wheels in kg m^2."""
    halfshaft_stiffness: float
    """Stiffness k_sa of the half-shafts in N m/rad."""
    halfshaft_damping: float
    """Damping c_sa of the half-shafts in N m s/rad."""
    working_torque: float
    """Torque in N m that a hard engagement takes of the clutch."""
    driven_share: float
    """Share of the weight on the driven front axle at rest, 0 to 1."""
    height_over_wheelbase: float
    """Height of the centre of gravity over the wheelbase, h/L."""

    @classmethod
    def of(cls, scenario: Scenario) -> 'JudgedPlant':
        """Return the plant of a scenario; in a gear shift both primary shafts turn."""
        driveline = (
            scenario.driveline if scenario.shift is None else gears_of(scenario).both_engaged
        )
        return cls.of_parameters(driveline, scenario.vehicle, scenario.friction)

    @classmethod
    def of_parameters(
        cls,
        driveline: DrivelineParameters,
        vehicle: VehicleParameters,
        friction: FrictionParameters,
    ) -> 'JudgedPlant':
        """Return the plant with a driveline, a vehicle and a clutch."""
        return cls(
            engine_inertia=driveline.engine_inertia,
            rest_inertia=driveline.vehicle_side_inertia,
            gear=driveline.gear,
            mass=vehicle.mass_kg,
            wheel_radius=vehicle.wheel_radius_m,
            gravity=vehicle.gravity_m_s2,
            engine_side_inertia=driveline.engine_inertia + driveline.shaft_inertia,
            vehicle_inertia=driveline.vehicle_inertia,
            halfshaft_stiffness=driveline.halfshaft_stiffness,
            halfshaft_damping=driveline.halfshaft_damping,
            working_torque=friction.working_torque,
            driven_share=vehicle.driven_share,
            height_over_wheelbase=vehicle.height_over_wheelbase,
        )

    @property
    def joint_inertia(self) -> float:
        """Inertia of the slip between two free inertias, J_m J_eq / (J_m + J_eq), in kg m^2."""
        return self.engine_inertia * self.rest_inertia / (self.engine_inertia + self.rest_inertia)
