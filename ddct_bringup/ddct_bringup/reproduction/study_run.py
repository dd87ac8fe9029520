# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Headless runs and their scores; runs of the thesis's scenario are cached."""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.metric import Metrics, finite
from ddct_bringup.metrics.values import compute_metrics, window_steps
from ddct_bringup.run.execution import recording_in_memory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import score_run
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.program.table import Quantity
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

THESIS_SCENARIO = load_scenario('thesis')
THESIS_SETTINGS = RunSettings(KnownSettings(THESIS_SCENARIO))
SLIP_ERROR = Quantity(
    'slip_rmse_rpm',
    'RMSE w_d',
    'rpm',
    '.2f',
    'root mean square of reference less w_d over the score window',
)


@dataclass(frozen=True, eq=False)
class StudyRun:
    """One run; its scores are computed on first access."""

    settings: RunSettings
    controller: str | Controller
    """Name in the registry, or the controller object."""
    trajectory: Trajectory

    @cached_property
    def metrics(self) -> Metrics:
        """Metrics of the run in its scenario's score window, and the slip error of figures."""
        scenario = self.settings.scenario
        computed = compute_metrics(
            self.trajectory,
            control_start_s=scenario.control_start_s,
            score_window_s=scenario.score_window_s,
        )
        return {**computed, SLIP_ERROR.key: self._slip_error_rpm}

    @property
    def _slip_error_rpm(self) -> float | None:
        """R.m.s. of reference less slip over the score window; None if the run ends before."""
        first, last = window_steps(self.settings.scenario.score_window_s)
        run = self.trajectory
        if run.steps < last:
            return None
        error = (run.at_tick('slip_reference') - run.slip_speed)[first : last + 1]
        return finite(rpm_from_rad_s(np.sqrt(np.mean(error**2))))

    @property
    def table_values(self) -> dict[str, float | None]:
        """Values of the three metrics of Table 5.1 by name; None for an undefined one."""
        return {name: self.metrics[name] for name in TABLE_METRICS}

    @cached_property
    def scores(self) -> ScoredRun:
        """Scores of the run by the packaged limits."""
        name = str(self.controller)
        recording = recording_in_memory(self.settings, name, self.trajectory)
        return score_run(recording, name, packaged_limits(), timing=None)

    @property
    def slip_rpm(self) -> np.ndarray:
        """Slip speed w_d in rpm, (N+1,)."""
        return rpm_from_rad_s(self.trajectory.slip_speed)

    @property
    def start(self) -> int:
        """Step at which control starts."""
        return self.settings.scenario.control_start_step


def study_run(settings: RunSettings, controller: str | Controller) -> StudyRun:
    """Run a controller headless."""
    return StudyRun(settings, controller, run_headless(settings, controller))


@cache
def thesis_run(controller: str, architecture: str, wear_gain: float) -> StudyRun:
    """Return the run of a controller of the registry in the thesis's scenario."""
    return study_run(
        RunSettings(
            KnownSettings(THESIS_SCENARIO, architecture), CaseSettings(wear_gain=wear_gain)
        ),
        controller,
    )


class StaticControllerAlone(Controller):
    """The static controller (Figure 1.17) alone: C_fOL on the clutch, the driver's demand."""

    def reset(self) -> None:
        """Do nothing: there is no state."""

    def update(self, measurement: Measurement) -> Command:
        """Return no torque."""
        return Command(0.0)
