"""What the verdict needs to know of the plant of a run besides its signals."""

import math
from dataclasses import dataclass

from ddct_plant.models.driveline import DrivelineParameters
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True)
class JudgedPlant:
    """Inertias, ratio and limits of the car that was driven, all SI."""

    engine_inertia: float
    """J_m in kg m^2."""
    rest_inertia: float
    """J_eq = J_p + J_v/tau^2 in kg m^2: the rest of the car, rigid, at the shaft."""
    total_ratio: float
    """tau."""
    cut_speed: float = math.inf
    """w_m in rad/s from which the rev limiter cuts the fuel; infinite without one."""

    @classmethod
    def of(cls, settings: RunSettings | None) -> 'JudgedPlant | None':
        """Return the plant of a run, None of one whose settings are not known."""
        if settings is None:
            return None
        return cls.of_driveline(settings.scenario.driveline, settings.scenario.cut_speed)

    @classmethod
    def of_driveline(
        cls, driveline: DrivelineParameters, cut_speed: float = math.inf
    ) -> 'JudgedPlant':
        """Return the plant with a driveline and a rev limiter."""
        ratio = driveline.total_ratio
        return cls(
            driveline.engine_inertia,
            driveline.shaft_inertia + driveline.vehicle_inertia / ratio**2,
            ratio,
            cut_speed,
        )

    @property
    def joint_inertia(self) -> float:
        """J_m J_eq / (J_m + J_eq) in kg m^2, that of the slip between two free inertias."""
        return self.engine_inertia * self.rest_inertia / (self.engine_inertia + self.rest_inertia)
