# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Fitted parameters of the calibration, their bounds, the PI, and the printed numbers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.reproduction.calibration.record_types import ResidualEntry
from ddct_bringup.thesis.table_5_1 import CALIBRATED, THESIS_TABLE, TOLERANCES
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_controllers.design.analysis.loops import sampled_plant
from ddct_controllers.linear import PI_OPTIONS
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import TorqueProfile
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.initial_speeds import InitialSection
from ddct_plant.scenario.scenario import Scenario

Values = Sequence[float] | np.ndarray
"""Values of the parameters, (6,), in the order of PARAMETERS."""
TARGETS = {row.controller: row.printed_values() for row in THESIS_TABLE if row.use == CALIBRATED}
ROWS = tuple(TARGETS)
"""Controllers whose rows are fitted."""


@dataclass(frozen=True)
class FittedParameter:
    """One fitted number, its bounds and where they come from."""

    name: str
    symbol: str
    unit: str
    lower: float
    upper: float
    decimals: int
    """Decimals that the scenario file keeps."""
    bounds_from: str


PARAMETERS = (
    FittedParameter(
        *('torque_start_n_m', 'C_m start', 'N m', 0.0, 60.0, 0),
        'no engine braking; low torque',
    ),
    FittedParameter(
        *('torque_end_n_m', 'C_m end', 'N m', 150.0, 350.0, 0),
        'highest input torque of the C635 is 350 N m (Section 1.1)',
    ),
    FittedParameter(
        *('rise_end_s', 'rise end', 's', 0.30, 0.60, 3),
        '"sudden growth" in "the first 0.5 seconds" (Chapter 6); control starts at 0.6 s',
    ),
    FittedParameter(
        *('slope_rad_s2', 'reference slope', 'rad/s^2', 40.0, 160.0, 0), 'wide; t_a decides'
    ),
    FittedParameter(*('proportional_gain', 'K_p', 'N m/rpm', 0.0, 0.3, 3), 'sign; wide above'),
    FittedParameter(*('integral_gain', 'K_i', 'N m/(rpm s)', 0.0, 0.5, 4), 'sign; wide above'),
)
NAMES = tuple(parameter.name for parameter in PARAMETERS)
FROZEN_GAINS = {name: PI_OPTIONS[name].default for name in NAMES[4:]}
"""Gains of a scenario that gives none: the calibrated ones, which are the defaults of `pi`."""
PI_ONLY = (4, 5)
"""Indices of the parameters that only the row of the PI depends on."""
LOWER = np.array([parameter.lower for parameter in PARAMETERS])
RANGE = np.array([parameter.upper for parameter in PARAMETERS]) - LOWER

DURATION_S = 3.0
"""Length of the thesis run in s; a score window cannot be longer."""
BASE = Scenario(
    name='thesis',
    description='Slip phase of Table 5.1, calibrated on its LS8, Hinf1 and PI rows',
    duration_s=DURATION_S,
    control_start_s=0.6,
    score_window_s=(0.6, DURATION_S),
    engine=TorqueProfile((0.0,), (0.0,)),
    given_initial=InitialSection(engine_speed_rad_s=160.0, shaft_speed_rad_s=160.0),
)
"""Fixed assumptions, among them both plates at 160 rad/s and the default road load."""


def values_of(scenario: Scenario) -> tuple[float, ...]:
    """Return the (6,) values of PARAMETERS; raise ParameterError for another kind of scenario."""
    engine, gains = scenario.engine, {**FROZEN_GAINS, **scenario.controllers.get('pi', {})}
    if len(engine.time_s) != 2 or engine.time_s[0] != 0.0:
        raise ParameterError(
            f'scenario {scenario.name} is not of the calibrated kind: engine torque from 0 s in '
            'one straight rise',
            key=scenario.name,
        )
    return (
        *engine.torque_n_m,
        engine.time_s[1],
        scenario.reference.slope_rad_s2,
        *(gains[name] for name in NAMES[4:]),
    )


def rounded(values: Values) -> tuple[float, ...]:
    """Return the values with the decimals that the scenario file keeps."""
    return tuple(
        round(value, parameter.decimals) + 0.0
        for value, parameter in zip(values, PARAMETERS, strict=True)
    )


def pi_growth_rate(
    parameters: DrivelineParameters, proportional_gain: float, integral_gain: float
) -> float:
    """
    Return the growth rate in 1/s of the loop's slowest-decaying mode; positive is unstable.

    State: request after its delay, actuator and driveline sampled at 10 ms, the integral of e.
    Load constant, clutch new, no saturation; u = -(K_p e + K_i integral of e), e = -w_d in rpm.
    """
    plant = sampled_plant(parameters)
    loop = np.block(
        [
            [plant.a + proportional_gain * plant.b @ plant.c, -integral_gain * plant.b],
            [-PERIOD_S * plant.c, np.ones((1, 1))],
        ]
    )
    return float(np.log(np.max(np.abs(np.linalg.eigvals(loop)))) / PERIOD_S)


def require_stable_pi(values: Values) -> None:
    """Raise DdctError unless the PI of the (6,) values of PARAMETERS stabilises the slip speed."""
    rate = pi_growth_rate(BASE.driveline, *values[4:])
    if not rate < 0.0:
        raise DdctError(
            f'the PI loop with gains {values[4]:g} and {values[5]:g} grows by {rate:.2g}/s: '
            'no scenario may leave the calibration with it',
            key='gains',
        )


def residual_rows(figures: Mapping[str, Mapping[str, float]]) -> list[ResidualEntry]:
    """Return one entry per value of each row: printed, computed, deviation and tolerance."""
    return [
        ResidualEntry(
            row=row,
            figure=name,
            printed=TARGETS[row][name],
            computed=computed[name],
            deviation=computed[name] / TARGETS[row][name] - 1.0,
            tolerance=TOLERANCES[name],
        )
        for row, computed in figures.items()
        for name in TABLE_METRICS
    ]


def outside_tolerance(rows: Sequence[ResidualEntry]) -> list[str]:
    """Return the entries outside their tolerance as text."""
    return [
        f'{entry.row} {entry.figure} {100.0 * entry.deviation:+.1f} %'
        for entry in rows
        if abs(entry.deviation) > entry.tolerance
    ]


def largest_residual(rows: Sequence[ResidualEntry]) -> float:
    """Return the largest deviation among the entries, in tolerances."""
    return max(abs(row.deviation) / row.tolerance for row in rows)
