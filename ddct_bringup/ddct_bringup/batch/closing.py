# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The closing stages of many runs."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.controllers.interface import Measured
from ddct_plant.base.timebase import PERIOD_S, steps_in
from ddct_plant.scenario.control import ClosingParameters
from ddct_plant.scenario.scenario import Scenario


class ClosingStages:
    """Closing stages of R runs, the counterpart of `ClosingStage`."""

    def __init__(self, scenarios: Sequence[Scenario], static_torques: Any) -> None:
        """
        Start open; `static_torques` is C_fOL of the scenarios.

        Runs of scenarios without a closing stage never close.
        """
        parameters = [each.closing or ClosingParameters() for each in scenarios]
        most = zip(parameters, scenarios, strict=True)
        self._static = static_torques
        self.there = np.array([each.closing is not None for each in scenarios])
        """Whether a run has a closing stage, (R,)."""
        self._most = np.array([each.most_request(scenario.friction) for each, scenario in most])
        self._band = np.array([each.slip_band_rad_s for each in parameters])
        self._dwell = np.array([steps_in('closing.dwell_s', each.dwell_s) for each in parameters])
        self._beyond = np.array([each.margin - 1.0 for each in parameters])
        self._reserve = np.array([each.reserve_n_m for each in parameters])
        self._most_change = np.array([each.ramp_n_m_s * PERIOD_S for each in parameters])
        self._within = np.zeros(len(parameters), dtype=int)
        self._added, self._margin, self._least_margin = np.zeros((3, len(parameters)))
        self.closed = np.zeros(len(parameters), dtype=bool)
        """Whether the clutch counts as locked, so that feedback is off, (R,)."""

    def update(
        self, measured: Measured, open_loop: np.ndarray, last_request: np.ndarray, on: np.ndarray
    ) -> np.ndarray:
        """
        Return the torques in N m that are added to the open loop over the coming period, (R,).

        `on` is whether the architecture has started feedback; the torques are in N m.
        """
        in_reach = self.closed | (last_request <= self._most)
        within = on & self.there & in_reach & self._within_band(measured)
        self._within = np.where(within, self._within + 1, 0)
        was_closed, self.closed = self.closed, self._within > self._dwell
        opening = self._along_ramp(self._added, 0.0)
        if not self.closed.any():
            self._added = opening
            return self._added
        carried = np.abs(
            self._static.torque(
                measured.engine_torque,
                measured.load_torque,
                measured.engine_speed,
                measured.shaft_speed,
            )
        )
        found = np.maximum(last_request, 0.0) - carried
        closes = self.closed & ~was_closed
        self._margin = np.where(closes, found, self._margin)
        self._least_margin = np.where(closes, found, self._least_margin)
        margin = self._along_ramp(self._margin, self._target_margin(carried))
        self._margin = np.where(self.closed, margin, self._margin)
        self._added = np.where(self.closed, carried + margin - open_loop, opening)
        return self._added

    def _within_band(self, measured: Measured) -> np.ndarray:
        reference = np.abs(measured.present_reference)
        within: np.ndarray = np.maximum(np.abs(measured.slip_speed), reference) <= self._band
        return within

    def _target_margin(self, carried: np.ndarray) -> np.ndarray:
        """Return the target margins over |C_fOL| in N m within the clutches' capacity, (R,)."""
        target = np.maximum(self._beyond * carried + self._reserve, self._least_margin)
        return np.maximum(np.minimum(target, self._most - carried), 0.0)

    def _along_ramp(self, torque: np.ndarray, target: np.ndarray | float) -> np.ndarray:
        """Return the torques in N m a period later, on their ramps to the target, (R,)."""
        near = np.abs(target - torque) <= self._most_change
        change = np.where(target > torque, self._most_change, -self._most_change)
        return np.where(near, target, torque + change)
