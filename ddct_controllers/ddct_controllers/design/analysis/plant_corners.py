"""The corners of the driveline's parameters, with the sampled plant at each."""

import itertools
from dataclasses import fields, replace

import numpy as np

from ddct_controllers.design.analysis.loops import IDENTIFIED_DRIVELINE, sampled_plant
from ddct_controllers.design.state_space import frequency_response
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.parameters import DrivelineParameters

PARAMETER_SPREAD = 0.2


class PlantCorners:
    """
    Every combination of driveline parameters 20 % below and above their nominal values.

    A parameter that is 0 stays 0. The thesis's driveline has 7 others, so 128 corners; they serve
    any number of controllers.
    """

    omega = np.geomspace(0.01, np.pi / PERIOD_S, 800)
    """Frequencies in rad/s of `responses`."""

    def __init__(self, nominal: DrivelineParameters = IDENTIFIED_DRIVELINE) -> None:
        """Sample the plant at every corner, with a new clutch."""
        self.varied = [field.name for field in fields(nominal) if getattr(nominal, field.name)]
        """Names of the parameters that differ between corners."""
        ends = (1.0 - PARAMETER_SPREAD, 1.0 + PARAMETER_SPREAD)
        self.factors = list(itertools.product(ends, repeat=len(self.varied)))
        """Per corner: multiples of the nominal values, in the order of `varied`."""
        self.parameters = [
            replace(
                nominal,
                **{
                    name: factor * getattr(nominal, name)
                    for name, factor in zip(self.varied, factors, strict=True)
                },
            )
            for factors in self.factors
        ]
        """Per corner: the driveline."""
        self.plants = [sampled_plant(parameters) for parameters in self.parameters]
        """Per corner: hold, delay, actuator and driveline, as `sampled_plant` gives them."""
        self.responses = np.array([frequency_response(p, self.omega) for p in self.plants])
        """(corners, frequencies), complex."""
