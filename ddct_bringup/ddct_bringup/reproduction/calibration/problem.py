# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The calibration of the thesis scenario as a least-squares problem.

The thesis prints no engine torque profile, no reference slope and no PI gains. They are fitted
to nine numbers, the LS8, Hinf1 and PI rows of its Table 5.1, without the MPC rows.
Parameters, bounds and numbers are in the module `parameters`.
"""

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from ddct_bringup.reproduction.calibration.parameters import (
    BASE,
    LOWER,
    NAMES,
    PARAMETERS,
    PI_ONLY,
    RANGE,
    ROWS,
    Values,
    pi_growth_rate,
    residual_rows,
)
from ddct_bringup.reproduction.calibration.record_types import FitEntry
from ddct_bringup.reproduction.study_run import study_run
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_plant.base.errors import DdctError
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.models.engine import TorqueProfile
from ddct_plant.scenario.control import ReferenceParameters
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

_STEP = 1e-4
"""Difference step of the Jacobian, as a share of each parameter's range."""
_PRECISION = 1e-5
"""Relative change of the objective or the parameters at which a fit ends."""


@dataclass(frozen=True)
class Problem:
    """Residuals of some rows of the table for one score window."""

    window_end_s: float
    """End of the score window in s; it starts with control."""
    rows: tuple[str, ...] = ROWS
    base: Scenario = BASE

    def scenario(self, values: Values) -> Scenario:
        """Return the scenario for the (6,) values of PARAMETERS."""
        start, end, rise_end, slope, proportional, integral = (float(value) for value in values)
        return dataclasses.replace(
            self.base,
            score_window_s=(self.base.control_start_s, self.window_end_s),
            engine=TorqueProfile((0.0, rise_end), (start, end)),
            reference=ReferenceParameters(slope),
            controllers={'pi': {'proportional_gain': proportional, 'integral_gain': integral}},
        )

    def computed_values(self, values: Values) -> dict[str, dict[str, float]]:
        """Return the computed values by row, then metric name."""
        scenario = self.scenario(values)
        return {row: row_values(scenario, row) for row in self.rows}

    def residuals(self, values: Values) -> np.ndarray:
        """Return (computed / printed - 1) / tolerance, (3 rows,), three values a row."""
        rows = residual_rows(self.computed_values(values))
        return np.array([row.deviation / row.tolerance for row in rows])

    def objective(self, values: Values) -> float:
        """Return half the sum of the squared scaled residuals."""
        return 0.5 * float(np.sum(self.residuals(values) ** 2))

    def jacobian(self, values: Values) -> np.ndarray:
        """Return d residuals / d (value / range) by one-sided differences, (3 rows, 6)."""
        origin = np.asarray(values, dtype=float)
        before = self.residuals(origin).reshape(-1, len(TABLE_METRICS))
        columns = []
        for index, parameter in enumerate(PARAMETERS):
            step = _STEP * RANGE[index]
            if origin[index] + step > parameter.upper:
                step = -step
            moved = origin.copy()
            moved[index] += step
            change = np.zeros_like(before)
            for number, row in enumerate(self.rows):
                if row == 'pi' or index not in PI_ONLY:
                    after = dataclasses.replace(self, rows=(row,)).residuals(moved)
                    change[number] = after - before[number]
            columns.append(change.ravel() * RANGE[index] / step)
        return np.column_stack(columns)


@dataclass(frozen=True)
class Fit:
    """A local optimum."""

    problem: Problem
    values: tuple[float, ...]
    """Values of the parameters, (6,), in the order of PARAMETERS."""
    residuals: np.ndarray
    """Scaled residuals, (3 rows,)."""

    @property
    def objective(self) -> float:
        """Half the sum of the squared scaled residuals."""
        return 0.5 * float(np.sum(self.residuals**2))

    @cached_property
    def pi_growth_rate(self) -> float:
        """Growth rate of the PI's slip loop in 1/s, negative when it is stable."""
        return pi_growth_rate(BASE.driveline, *self.values[4:])

    @property
    def pi_stable(self) -> bool:
        """Whether the PI stabilises the slip speed."""
        return self.pi_growth_rate < 0.0

    @property
    def pi_kind(self) -> str:
        """Part of the PI that moves the torque more in an engagement of about 1 s: 'P' or 'I'."""
        proportional, integral = self.values[4:]
        return 'P' if proportional >= integral else 'I'

    def as_record(self) -> FitEntry:
        """Return the entry of the fit in the record of a calibration."""
        return FitEntry(
            objective=self.objective,
            worst_residual=float(self.residuals[np.argmax(np.abs(self.residuals))]),
            values=dict(zip(NAMES, self.values, strict=True)),
        )


def row_values(scenario: Scenario, controller: str) -> dict[str, float]:
    """
    Return the three values of one controller, simulated to the end of the score window.

    Where w_d does not reach zero by then, t_a is the time simulated since control start plus the
    time that the slope of the reference needs for the remaining slip: defined everywhere,
    continuous, and larger for a worse run. Raise DdctError for a run that is not finite.
    """
    _, end = scenario.score_window_s
    shortened = dataclasses.replace(scenario, duration_s=end)
    run = study_run(RunSettings(KnownSettings(shortened)), controller)
    figures, final_rpm = run.table_values, run.metrics['slip_final_rpm']
    if figures['engagement_time_s'] is None and final_rpm is not None:
        left = abs(rad_s_from_rpm(final_rpm)) / scenario.reference.slope_rad_s2
        figures['engagement_time_s'] = end - scenario.control_start_s + left
    defined = {name: value for name, value in figures.items() if value is not None}
    missing = [name for name in figures if name not in defined]
    if missing:
        raise DdctError(f'{controller} has no {", ".join(missing)}: narrow the bounds')
    return defined


def fit(
    problem: Problem, start: Values, free: Sequence[int] = tuple(range(len(PARAMETERS)))
) -> Fit:
    """
    Return the local optimum from (6,) start values; parameters not in `free` keep theirs.

    A trust-region method within the bounds, each parameter scaled by its range.
    """
    free = list(free)
    origin = np.asarray(start, dtype=float)

    def values_at(shares: np.ndarray) -> np.ndarray:
        values = origin.copy()
        values[free] = LOWER[free] + shares * RANGE[free]
        return values

    shares = np.clip((origin - LOWER) / RANGE, 1e-6, 1.0 - 1e-6)[free]
    answer = scipy.optimize.least_squares(
        lambda shares: problem.residuals(values_at(shares)),
        shares,
        jac=lambda shares: problem.jacobian(values_at(shares))[:, free],
        bounds=(0.0, 1.0),
        ftol=_PRECISION,
        xtol=_PRECISION,
        gtol=_PRECISION,
        max_nfev=60,
    )
    return Fit(problem, tuple(values_at(answer.x).tolist()), answer.fun)
