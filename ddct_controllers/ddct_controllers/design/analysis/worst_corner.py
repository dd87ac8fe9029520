# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The worst corner: margins over wear and the corners of the driveline's parameters."""

import itertools
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from ddct_controllers.design.analysis.driveline_mode import (
    damping,
    locked_driveline_zeros,
    nearest_mode,
)
from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import (
    IDENTIFIED_DRIVELINE,
    WEAR_RANGE,
    require_sampled,
)
from ddct_controllers.design.analysis.refinement import zeros
from ddct_controllers.design.loop_stack import LoopStack
from ddct_controllers.design.state_space import frequency_response, to_s_plane
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import RPM_PER_RAD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.driveline_model import driveline_matrices
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
        paths = [
            driveline_matrices(p).path('clutch_torque', 'slip_speed') for p in self.parameters
        ]
        self._paths = LoopStack.joined(paths)
        in_rpm = replace(self._paths, c=self._paths.c * RPM_PER_RAD_S)
        self.plants = in_rpm.behind(actuator.dynamics()).behind_delay(actuator.delay_substeps)
        """
        Sampled plants of the corners: hold, delay, actuator and driveline, with the states of
        `sampled_plant`.
        """
        self.responses = self.plants.responses(self.omega)
        """Frequency responses of the plants, (corners, frequencies), complex."""

    @cached_property
    def zeros(self) -> np.ndarray:
        """Zero of P_2 per corner, (corners,) complex, as `locked_driveline_zeros` returns them."""
        return locked_driveline_zeros(self._paths)


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


class CornerLoops:
    """The loops of a controller at the corners; what is not asked for is not computed."""

    def __init__(self, controller: StateSpace, corners: PlantCorners) -> None:
        """Take the loops of a controller that `sampled_loop` accepts."""
        require_sampled(controller)
        self._corners = corners
        self._loops = corners.plants.behind(controller)
        self._responses = corners.responses * frequency_response(controller, corners.omega)

    @cached_property
    def unstable(self) -> np.ndarray:
        """Whether each corner is unstable at some wear gain of the range, (corners,)."""
        unstable = (np.abs(self._poles_at_ends) >= 1.0).any(axis=(1, 2))
        crossed = _crossings(self._responses) & ~unstable[:, np.newaxis]
        corners, first = np.nonzero(crossed)
        loops = self._loops.some(corners)

        def phase(omega: np.ndarray) -> np.ndarray:
            return _phase(loops.pointwise(omega))

        ends = self._corners.omega[first], self._corners.omega[first + 1]
        phases = _phase(self._responses)
        omega = zeros(phase, *ends, phases[corners, first], phases[corners, first + 1])
        gains = -1.0 / loops.pointwise(omega).real
        unstable[corners[(gains >= WEAR_GAINS[0]) & (gains <= WEAR_GAINS[-1])]] = True
        return unstable

    @cached_property
    def _poles_at_ends(self) -> np.ndarray:
        """Closed-loop poles at the least and the greatest wear gain, (corners, 2, n)."""
        return np.linalg.eigvals(self._loops.closed(np.array(WEAR_RANGE)))

    @cached_property
    def _poles(self) -> np.ndarray:
        """Closed-loop poles at the three wear gains, (corners, 3, n)."""
        between = np.linalg.eigvals(self._loops.closed(np.array(WEAR_GAINS[1:-1])))
        ends = self._poles_at_ends
        return np.concatenate([ends[:, :1], between, ends[:, 1:]], axis=1)

    @property
    def sensitivity_peak(self) -> float | None:
        """Highest M_s of the corners and wear gains, None when a corner is unstable."""
        return self._worst[2]

    @cached_property
    def _worst(self) -> tuple[int, float, float | None]:
        """Index, wear gain and M_s of the worst corner."""
        if self.unstable.any():
            radius = np.abs(self._poles).max(axis=2)
            index, wear = np.unravel_index(np.argmax(radius), radius.shape)
            return int(index), WEAR_GAINS[wear], None
        return self._highest_peak()

    def worst(self) -> WorstCorner:
        """Return the worst corner."""
        index, wear_gain, peak = self._worst
        return WorstCorner(
            unstable_corners=int(np.count_nonzero(self.unstable)),
            index=index,
            wear_gain=wear_gain,
            sensitivity_peak=peak,
            least_mode_damping=self._least_mode_damping(),
        )

    def _highest_peak(self) -> tuple[int, float, float]:
        """Return the corner, the wear gain and the M_s of the highest M_s."""
        on_grid = _sensitivity(self._responses).max(axis=1)
        peak, worst, gain = 0.0, 0, 1.0
        for index in np.flatnonzero(on_grid >= _CANDIDATE_SHARE * on_grid.max()).tolist():
            curve = LoopCurve(self._loops.sampled(index))
            found, omega = curve.peak(_sensitivity)
            if found > peak:
                peak, worst = found, index
                gain = float(_worst_wear(np.array([curve.at(omega)]))[0])
        return worst, gain, peak

    def _least_mode_damping(self) -> float | None:
        """Return the least damping of the driveline modes, None where no loop oscillates."""
        rates = to_s_plane(self._poles, PERIOD_S)
        nearest = nearest_mode(rates, self._corners.zeros[:, np.newaxis])
        modes = np.take_along_axis(rates, nearest[..., np.newaxis], axis=-1)[nearest >= 0]
        return float(damping(modes).min()) if modes.size else None


def worst_corner(controller: StateSpace, corners: PlantCorners) -> WorstCorner:
    """Return the worst corner for a controller in the form that `sampled_loop` accepts."""
    return CornerLoops(controller, corners).worst()


def _sensitivity(values: np.ndarray) -> np.ndarray:
    """Return the highest |1/(1 + k L)| over the wear gains k, elementwise."""
    return 1.0 / np.abs(1.0 + _worst_wear(values) * values)


def _worst_wear(values: np.ndarray) -> np.ndarray:
    """Return the k in the wear range that brings k L nearest to -1: a point on a ray."""
    nearest = -values.real / np.abs(values) ** 2
    return np.clip(nearest, WEAR_GAINS[0], WEAR_GAINS[-1])


def _phase(responses: np.ndarray) -> np.ndarray:
    """Return the sine of the phase of L, which changes its sign where L is real, elementwise."""
    return responses.imag / np.abs(responses)


def _crossings(responses: np.ndarray) -> np.ndarray:
    """Return whether k L passes near -1 from each point to the next, for a k in the range."""
    imaginary, real = responses.imag, responses.real
    changes = (imaginary[:, 1:] > 0.0) != (imaginary[:, :-1] > 0.0)
    share = imaginary[:, :-1] / (imaginary[:, :-1] - imaginary[:, 1:])
    crossed = real[:, :-1] + share * (real[:, 1:] - real[:, :-1])
    near = (crossed < -0.9 / WEAR_GAINS[-1]) & (crossed > -1.1 / WEAR_GAINS[0])
    return changes & near
