"""What the verdict needs to know of the plant of a run besides its signals."""

import math
from dataclasses import dataclass

from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters
from ddct_plant.scenario.scenario import Scenario


@dataclass(frozen=True)
class JudgedPlant:
    """Inertias, ratio and limits of the car that was driven, all SI."""

    engine_inertia: float
    """J_m in kg m^2."""
    rest_inertia: float
    """J_eq = J_p + J_v/tau^2 in kg m^2: the rest of the car, rigid, at the shaft."""
    total_ratio: float
    """tau."""
    mass: float
    """m_v in kg."""
    wheel_radius: float
    """r_w in m."""
    gravity: float
    """g in m/s^2."""
    cut_speed: float = math.inf
    """w_m in rad/s from which the rev limiter cuts the fuel; infinite without one."""

    @classmethod
    def of(cls, scenario: Scenario) -> 'JudgedPlant':
        """Return the plant that a scenario describes."""
        return cls.of_parameters(scenario.driveline, scenario.vehicle, scenario.cut_speed)

    @classmethod
    def of_parameters(
        cls,
        driveline: DrivelineParameters,
        vehicle: VehicleParameters,
        cut_speed: float = math.inf,
    ) -> 'JudgedPlant':
        """Return the plant with a driveline, a vehicle and a rev limiter."""
        ratio = driveline.total_ratio
        return cls(
            engine_inertia=driveline.engine_inertia,
            rest_inertia=driveline.shaft_inertia + driveline.vehicle_inertia / ratio**2,
            total_ratio=ratio,
            mass=vehicle.mass_kg,
            wheel_radius=vehicle.wheel_radius_m,
            gravity=vehicle.gravity_m_s2,
            cut_speed=cut_speed,
        )

    @property
    def joint_inertia(self) -> float:
        """J_m J_eq / (J_m + J_eq) in kg m^2, that of the slip between two free inertias."""
        return self.engine_inertia * self.rest_inertia / (self.engine_inertia + self.rest_inertia)
