# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The worst corner: margins over wear and the corners of the driveline's parameters."""

import itertools
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ddct_controllers.design.analysis.driveline_mode import (
    damping,
    locked_driveline_zero,
    nearest_mode,
)
from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import (
    IDENTIFIED_DRIVELINE,
    WEAR_RANGE,
    sampled_plant,
)
from ddct_controllers.design.state_space import (
    close_loop,
    frequency_response,
    scaled,
    series,
    to_s_plane,
)
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.parameters import DrivelineParameters

PARAMETER_SPREAD = 0.2
WEAR_GAINS = (WEAR_RANGE[0], 1.0, WEAR_RANGE[1])
"""Values of K_usura, without unit: the ends of its range, and that of a new clutch."""
_CANDIDATE_SHARE = 0.95
"""Share of the highest M_s on the grid from which a corner's M_s is solved for exactly."""


class PlantCorners:
    """
    Every combination of driveline parameters 20 % below and above their nominal values.

    A parameter that is 0 stays 0. The thesis's driveline has 7 others, so 128 corners; they serve
    any number of controllers.
    """

    omega = np.geomspace(0.01, np.pi / PERIOD_S, 800)
    """Frequencies in rad/s of `responses`."""

    def __init__(
        self,
        nominal: DrivelineParameters = IDENTIFIED_DRIVELINE,
        actuator: ActuatorParameters = PRINTED_ACTUATOR,
    ) -> None:
        """Sample the plant at every corner, with a new clutch and one actuator."""
        self.actuator = actuator
        values = nominal.values()
        self.varied = [name for name, value in values.items() if value]
        """Names of the parameters that differ between corners."""
        ends = (1.0 - PARAMETER_SPREAD, 1.0 + PARAMETER_SPREAD)
        self.factors = list(itertools.product(ends, repeat=len(self.varied)))
        """Multiples of the nominal values per corner, in the order of `varied`."""
        self.parameters = [
            nominal.with_values(
                **{
                    name: factor * values[name]
                    for name, factor in zip(self.varied, factors, strict=True)
                }
            )
            for factors in self.factors
        ]
        """Parameters of the driveline per corner."""
        self.plants = [sampled_plant(each, actuator=actuator) for each in self.parameters]
        """
        Sampled plant per corner: hold, delay, actuator and driveline, as `sampled_plant` returns
        it.
        """
        self.responses = np.array([frequency_response(p, self.omega) for p in self.plants])
        """Frequency responses of the plants, (corners, frequencies), complex."""
        self.zeros = [locked_driveline_zero(each) for each in self.parameters]
        """Zero of P_2 per corner, as `locked_driveline_zero` returns it."""


@lru_cache(maxsize=4)
def plant_corners(
    nominal: DrivelineParameters = IDENTIFIED_DRIVELINE,
    actuator: ActuatorParameters = PRINTED_ACTUATOR,
) -> PlantCorners:
    """Return the corners around a driveline with an actuator; recent ones are kept."""
    return PlantCorners(nominal, actuator)


@dataclass(frozen=True)
class WorstCorner:
    """The corner, among all corners and wear gains from 0.7 to 1.3, nearest instability."""

    unstable_corners: int
    """Number of corners that are unstable at some wear gain of the range."""
    index: int
    """
    Index of the worst corner, the one of highest M_s.

    If any is unstable, that of the fastest growing pole.
    """
    wear_gain: float
    """Wear gain K_usura at the worst corner, without unit."""
    sensitivity_peak: float | None
    """Peak M_s at the worst corner, None when a corner is unstable."""
    least_mode_damping: float | None
    """Least damping ratio of the driveline mode over all corners, at wear gains 0.7, 1 and 1.3."""


def worst_corner(controller: StateSpace, corners: PlantCorners) -> WorstCorner:
    """Return the worst corner for a controller in the form that `sampled_loop` accepts."""
    loops = [series(controller, plant) for plant in corners.plants]
    responses = corners.responses * frequency_response(controller, corners.omega)
    poles = np.linalg.eigvals(
        [[close_loop(scaled(loop, gain)).a for gain in WEAR_GAINS] for loop in loops]
    )
    radius = np.abs(poles).max(axis=2)
    unstable = (radius >= 1.0).any(axis=1)
    for index in np.flatnonzero(~unstable & _may_cross(responses)):
        gains = LoopCurve(loops[index]).critical_gains()
        unstable[index] = any(WEAR_GAINS[0] <= gain <= WEAR_GAINS[-1] for gain in gains)
    if unstable.any():
        index, wear = np.unravel_index(np.argmax(radius), radius.shape)
        worst, wear_gain, peak = int(index), WEAR_GAINS[wear], None
    else:
        worst, wear_gain, peak = _highest_peak(loops, responses)
    return WorstCorner(
        unstable_corners=int(np.count_nonzero(unstable)),
        index=worst,
        wear_gain=wear_gain,
        sensitivity_peak=peak,
        least_mode_damping=_least_mode_damping(poles, corners),
    )


def _highest_peak(loops: list[StateSpace], responses: np.ndarray) -> tuple[int, float, float]:
    """Return the corner, the wear gain and the M_s of the highest M_s."""
    on_grid = _sensitivity(responses).max(axis=1)
    peak, worst, gain = 0.0, 0, 1.0
    for index in np.flatnonzero(on_grid >= _CANDIDATE_SHARE * on_grid.max()).tolist():
        curve = LoopCurve(loops[index])
        found, omega = curve.peak(_sensitivity)
        if found > peak:
            peak, worst = found, index
            gain = float(_worst_wear(np.array([curve.at(omega)]))[0])
    return worst, gain, peak


def _sensitivity(values: np.ndarray) -> np.ndarray:
    """Return the highest |1/(1 + k L)| over the wear gains k, elementwise."""
    return 1.0 / np.abs(1.0 + _worst_wear(values) * values)


def _worst_wear(values: np.ndarray) -> np.ndarray:
    """Return the k in the wear range that brings k L nearest to -1: a point on a ray."""
    nearest = -values.real / np.abs(values) ** 2
    return np.clip(nearest, WEAR_GAINS[0], WEAR_GAINS[-1])


def _may_cross(responses: np.ndarray) -> np.ndarray:
    """Return per corner whether k L passes near -1 between two points for a k in the range."""
    imaginary, real = responses.imag, responses.real
    changes = (imaginary[:, 1:] > 0.0) != (imaginary[:, :-1] > 0.0)
    share = imaginary[:, :-1] / (imaginary[:, :-1] - imaginary[:, 1:])
    crossed = real[:, :-1] + share * (real[:, 1:] - real[:, :-1])
    near = (crossed < -0.9 / WEAR_GAINS[-1]) & (crossed > -1.1 / WEAR_GAINS[0])
    return (changes & near).any(axis=1)


def _least_mode_damping(poles: np.ndarray, corners: PlantCorners) -> float | None:
    rates = to_s_plane(poles, PERIOD_S)
    found = []
    for zero, per_wear in zip(corners.zeros, rates, strict=True):
        modes = ((row, nearest_mode(row, zero)) for row in per_wear)
        found += [float(damping(row[mode])) for row, mode in modes if mode is not None]
    return min(found, default=None)
