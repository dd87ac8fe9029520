# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The whole calibration: its record, and the drive and scenario files made from it."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.reproduction.calibration.analysis import (
    FITTED_NUMBERS,
    Identifiability,
    identifiability,
    leave_one_row_out,
    vary_assumptions,
)
from ddct_bringup.reproduction.calibration.parameters import (
    BASE,
    LOWER,
    NAMES,
    PARAMETERS,
    RANGE,
    require_stable_pi,
    residual_rows,
    rounded,
    values_of,
)
from ddct_bringup.reproduction.calibration.problem import Fit, Problem, fit
from ddct_bringup.reproduction.calibration.record_types import (
    CalibrationRecord,
    CheckRecord,
    DerivedEntry,
    FittedParameterEntry,
    IdentifiabilityEntry,
    ObjectiveEntry,
    OptimumEntry,
)
from ddct_bringup.reproduction.calibration.search import Progress, lowest_stable, search
from ddct_bringup.thesis.table_5_1 import TOLERANCES
from ddct_plant.models.load import LoadParameters
from ddct_plant.scenario.scenario import Scenario

RETURN_TOLERANCE = 0.01
"""Largest change of a parameter in a refit of the frozen scenario, as a share of its range."""
MOVES = ('torque_rise_n_m', *NAMES[2:])
"""Quantities in which a refit is compared; C_m end minus C_m start, as both are not determined."""
_DRIVE_HEAD = (
    '# The slip phase behind Table 5.1 of the thesis, which does not print it.',
    '# Written by `ddct reproduce calibration --write FILE`: docs/thesis/calibration.md.',
    '# fitted: to the LS8, Hinf1 and PI rows of Table 5.1; what they show is a fit residual.',
    '# assumed: chosen by us; docs/thesis/calibration.md shows fits with other choices.',
)


def calibrate(progress: Progress) -> CalibrationRecord:
    """Run the whole calibration and return its record; raise DdctError without a stable PI."""
    windows, starts = search(progress)
    optimum = lowest_stable(starts)
    frozen = rounded(optimum.values)
    require_stable_pi(frozen)
    analysis = identifiability(optimum)
    return CalibrationRecord(
        objective=ObjectiveEntry(
            value=optimum.objective,
            residual_tolerances=TOLERANCES,
            numbers=len(optimum.residuals),
            fitted=FITTED_NUMBERS,
        ),
        score_window_s=[BASE.control_start_s, optimum.problem.window_end_s],
        parameters=_parameters(optimum.values, frozen, analysis),
        torque_and_slopes=_torque_and_slopes(optimum.values, analysis),
        residuals=residual_rows(optimum.problem.computed_values(frozen)),
        frozen_objective=optimum.problem.objective(frozen),
        windows=[_optimum(one) for one in windows],
        starts=[_optimum(one) for one in starts],
        identifiability=IdentifiabilityEntry(
            degrees_of_freedom=analysis.degrees_of_freedom,
            residual_std=analysis.residual_std,
            coverage_95=analysis.coverage_95,
            singular_values=analysis.singular_values.tolist(),
            directions=analysis.directions.tolist(),
            weakest=dict(zip(NAMES, analysis.weakest.tolist(), strict=True)),
            correlation_given_start=analysis.correlation_given_start.tolist(),
        ),
        left_out=leave_one_row_out(optimum, progress),
        assumptions=vary_assumptions(optimum, progress),
    )


def check_frozen(scenario: Scenario, progress: Progress) -> CheckRecord:
    """
    Return the residuals of a calibrated scenario, and its changes by a local refit.

    Raise DdctError when its PI does not stabilise the slip speed.
    """
    frozen = values_of(scenario)
    require_stable_pi(frozen)
    problem = Problem(scenario.score_window_s[1], base=scenario)
    progress('local refit')
    refit = fit(problem, frozen)
    change = np.subtract(refit.values, frozen)
    moved = [float(change[1] - change[0]) / RANGE[1], *(change[2:] / RANGE[2:]).tolist()]
    return CheckRecord(
        score_window_s=list(scenario.score_window_s),
        residuals=residual_rows(problem.computed_values(frozen)),
        frozen_objective=problem.objective(frozen),
        refit=refit.as_record(),
        moved=dict(zip(MOVES, moved, strict=True)),
    )


def _parameters(
    values: Sequence[float], frozen: Sequence[float], analysis: Identifiability
) -> list[FittedParameterEntry]:
    shares = (np.array(values) - LOWER) / RANGE
    near = np.minimum(shares, 1.0 - shares) < 1e-3
    return [
        FittedParameterEntry(
            name=parameter.name,
            symbol=parameter.symbol,
            unit=parameter.unit,
            lower=parameter.lower,
            upper=parameter.upper,
            bounds_from=parameter.bounds_from,
            value=values[index],
            frozen=frozen[index],
            at_bound=bool(near[index]),
            std=float(analysis.std[index]),
            std_given_start=float(analysis.std_given_start[index]) if index else None,
        )
        for index, parameter in enumerate(PARAMETERS)
    ]


def _torque_and_slopes(values: Sequence[float], analysis: Identifiability) -> list[DerivedEntry]:
    """Return levels, rise and slopes that the fit implies, with their standard errors."""
    start, end, rise_end, slope = values[:4]
    rate = (end - start) / rise_end
    none = (0.0, 0.0)
    quantities = (
        ('C_m start', 'N m', start, (1.0, 0.0, 0.0, 0.0, *none)),
        ('C_m end', 'N m', end, (0.0, 1.0, 0.0, 0.0, *none)),
        ('rise of C_m', 'N m', end - start, (-1.0, 1.0, 0.0, 0.0, *none)),
        ('slope of C_m', 'N m/s', rate, (*np.divide((-1.0, 1.0, -rate), rise_end), 0.0, *none)),
        ('slope of the reference', 'rad/s^2', slope, (0.0, 0.0, 0.0, 1.0, *none)),
    )
    entries: list[DerivedEntry] = []
    for quantity, unit, value, gradient in quantities:
        std, given_start = analysis.std_of(gradient)
        entries.append(
            DerivedEntry(
                quantity=quantity,
                unit=unit,
                value=value,
                std=std,
                std_given_start=given_start,
            )
        )
    return entries


def _optimum(one: Fit) -> OptimumEntry:
    return OptimumEntry(
        window_end_s=one.problem.window_end_s,
        pi_kind=one.pi_kind,
        pi_growth_rate_per_s=one.pi_growth_rate,
        pi_stable=one.pi_stable,
        fit=one.as_record(),
    )


def drive_text(record: CalibrationRecord) -> str:
    """Return the calibrated drive as YAML, with comments on the source of each value."""
    values = [entry.frozen for entry in record.parameters]
    scenario = Problem(record.score_window_s[1]).scenario(values)
    lines = [(f'description: {scenario.description}', ''), *_drive_lines(scenario)]
    return _commented(_DRIVE_HEAD, lines)


def member_text(scenario: Scenario, head: Sequence[str]) -> str:
    """Return a scenario of the calibrated kind as YAML below its head of comments."""
    load, usual = vars(scenario.load), vars(LoadParameters())
    changed = [name for name in load if load[name] != usual[name]]
    lines = [
        (f'description: {scenario.description}', ''),
        ('car: c635_thesis', ''),
        ('drive:', ''),
        *((f'  {text}', comment) for text, comment in _drive_lines(scenario)),
        *([('set:', '')] if changed else []),
        *((f'  load.{name}: {load[name]}', '') for name in changed),
        ('controllers:', ''),
        ('  pi:', 'fitted, to the PI row only'),
        *((f'    {name}: {gain}', '') for name, gain in scenario.controllers['pi'].items()),
    ]
    return _commented(head, lines)


def _drive_lines(scenario: Scenario) -> list[tuple[str, str]]:
    """Return the lines of the drive of a scenario, each with its comment."""
    first, last = scenario.score_window_s
    time, torque = (list(part) for part in (scenario.engine.time_s, scenario.engine.torque_n_m))
    return [
        (f'duration_s: {scenario.duration_s}', 'assumed'),
        (f'control_start_s: {scenario.control_start_s}', 'thesis, Section 1.4.1'),
        (f'score_window_s: [{first}, {last}]', 'from control start; the end is fitted'),
        ('engine:', ''),
        (f'  time_s: {time}', 'the end of the rise is fitted'),
        (f'  torque_n_m: {torque}', 'fitted; only the rise is determined, not its level'),
        ('initial:', 'assumed: no slip; 160 rad/s is 20 km/h in second gear'),
        *(
            (f'  {name}: {value}', '')
            for name, value in vars(scenario.given_initial).items()
            if value is not None
        ),
        ('reference:', ''),
        (f'  slope_rad_s2: {scenario.reference.slope_rad_s2}', 'fitted'),
    ]


def _commented(head: Sequence[str], lines: Sequence[tuple[str, str]]) -> str:
    """Return the text of a file: its head, then lines with their comments."""
    body = [f'{text:<37} # {comment}' if comment else text for text, comment in lines]
    return '\n'.join([*head, *body, ''])
