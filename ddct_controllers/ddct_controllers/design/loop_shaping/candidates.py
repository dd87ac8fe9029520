# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Candidates for a loop-shaping controller: by crossover, each with the largest allowed zeros."""

import math
from bisect import bisect
from collections.abc import Iterator
from functools import cache

import numpy as np

from ddct_controllers.design.analysis.loops import plant_in_rpm, sampled_plant
from ddct_controllers.design.analysis.margins import closed_loop_stable
from ddct_controllers.design.analysis.step_response import rise_time_and_overshoot
from ddct_controllers.design.loop_shaping.design import (
    integrators,
    lead_network,
    placement,
    stabilising_sign,
    with_crossover,
)
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.design.loop_shaping.verification import LARGEST_SENSITIVITY_PEAK
from ddct_controllers.design.state_space import frequency_response, series
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.parameters import DrivelineParameters

_LEAD_POLE_RATIO = 10.0
"""Pole of a lead network over the crossover; it costs 6 degrees of the lead."""
_ZERO_RATIOS = np.geomspace(0.002, 0.5, 64)
"""Zeros over the crossover, from the least overshoot to the quickest recovery."""
_CROSSOVERS_RAD_S = np.geomspace(0.05, 50.0, 150)
"""
Candidate crossovers in rad/s, 5 % apart.

They are the same for all specifications, so that one search reaches the results of another.
"""
_FIRST_CROSSOVER = 0.7
"""Start of the search, as a share of the crossover of the prototype."""
_SEARCH_TIME = 15.0
"""Length of a step response of the search over 1/w_c: past the highest overshoot."""
_OMEGA = np.geomspace(1e-2, math.pi / PERIOD_S, 200)
"""Frequencies in rad/s at which the search evaluates S and T."""


class Candidates:
    """Candidates for one set of specifications."""

    def __init__(
        self,
        specifications: TimeSpecifications,
        count: int,
        parameters: DrivelineParameters,
        actuator: ActuatorParameters = PRINTED_ACTUATOR,
    ) -> None:
        """Take the specifications, `count` integrators, the driveline and the actuator."""
        self._specifications = specifications
        self._count = count
        self._parameters = parameters
        self._plant = plant_in_rpm(parameters)
        self._sign = float(stabilising_sign(self._plant, count))
        self._sampled_plant = sampled_plant(parameters, actuator=actuator)
        self._plant_response = frequency_response(self._sampled_plant, _OMEGA)
        first_rad_s = _FIRST_CROSSOVER * specifications.crossover_rad_s
        self._first = int(np.searchsorted(_CROSSOVERS_RAD_S, first_rad_s))
        self._fastest_s = math.inf

    def fast_enough(
        self, structure: str, within_contours: bool
    ) -> Iterator[FactoredTransferFunction]:
        """Yield controllers, fast enough and with little enough overshoot, by crossover."""
        for crossover in _CROSSOVERS_RAD_S[self._first :]:
            found = self._quickest(structure, float(crossover), within_contours)
            if found is None:
                return
            controller, rise_time_s = found
            self._fastest_s = min(self._fastest_s, rise_time_s)
            if rise_time_s <= self._specifications.rise_time_s:
                yield controller

    def fastest_s(self, structures: tuple[str, ...]) -> float:
        """
        Return the shortest rise time in s of the controllers yielded or passed over, inf for none.

        Where all of these are too slow, slower crossovers of the structures count too.
        """
        if self._fastest_s <= self._specifications.rise_time_s:
            return self._fastest_s
        return min(self._fastest_s, *(self._slower_s(structure) for structure in structures))

    def _slower_s(self, structure: str) -> float:
        """Return the rise time with the highest crossover below those that were tried, or inf."""
        for crossover in _CROSSOVERS_RAD_S[: self._first][::-1]:
            found = self._quickest(structure, float(crossover), within_contours=False)
            if found is not None and math.isfinite(found[1]):
                return found[1]
        return math.inf

    def _quickest(
        self, structure: str, crossover: float, within_contours: bool
    ) -> tuple[FactoredTransferFunction, float] | None:
        """Return the controller with the largest allowed zeros, and its rise time in s."""

        @cache
        def found(index: int) -> tuple[FactoredTransferFunction, float] | None:
            return self._allowed(structure, crossover, _ZERO_RATIOS[index], within_contours)

        def refused(index: int) -> bool:
            return found(index) is None

        if refused(0) or not self._count:
            return found(0)
        # False sorts before True: this is the first of the rising ratios that is refused.
        first_refused = bisect(range(len(_ZERO_RATIOS)), False, lo=1, key=refused)
        return found(first_refused - 1)

    def _allowed(
        self, structure: str, crossover: float, ratio: float, within_contours: bool
    ) -> tuple[FactoredTransferFunction, float] | None:
        """Return controller and rise time (inf for none) if the overshoot is allowed."""
        controller = self._controller(structure, crossover, float(ratio))
        sampled = discretise_zoh(controller.to_state_space(), PERIOD_S)
        loop = series(sampled, self._sampled_plant)
        if not closed_loop_stable(loop) or not self._within_bounds(sampled, within_contours):
            return None
        rise_time_s, highest = rise_time_and_overshoot(loop, _SEARCH_TIME / crossover)
        if highest > self._specifications.overshoot:
            return None
        return controller, math.inf if rise_time_s is None else rise_time_s

    def _within_bounds(self, sampled: StateSpace, within_contours: bool) -> bool:
        """Return whether |S| is low enough, and |S| and |T| below S_p and T_p if required."""
        values = frequency_response(sampled, _OMEGA) * self._plant_response
        sensitivity = np.abs(1.0 / (1.0 + values))
        if not within_contours:
            return bool(np.max(sensitivity) <= LARGEST_SENSITIVITY_PEAK)
        s_p = min(self._specifications.sensitivity_peak, LARGEST_SENSITIVITY_PEAK)
        t_p = self._specifications.complementary_peak
        complementary = sensitivity * np.abs(values)
        return bool(np.max(sensitivity) <= s_p and np.max(complementary) <= t_p)

    def _controller(
        self, structure: str, crossover: float, ratio: float
    ) -> FactoredTransferFunction:
        if structure == 'placement':
            return placement(crossover, ratio * crossover, self._parameters, self._count)
        lead = lead_network(ratio * crossover, _LEAD_POLE_RATIO / ratio)
        shape = integrators(self._sign, self._count)
        for _ in range(self._count):
            shape = shape * lead
        return with_crossover(shape, self._plant, crossover)
