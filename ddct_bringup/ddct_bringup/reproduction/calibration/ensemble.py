# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Scenarios that the nine fitted values admit, and the ensemble of those that are kept.

A scenario is admissible when
- w_d reaches zero with each of the three fitted controllers, and each of the nine values (rows
  LS8, Hinf1 and PI of Table 5.1), of its whole run in its own score window, is within the
  calibration's tolerance of the print: 5 % for t_a, 10 % for both sigmas,
- the PI loop is stable,
- every fitted value is within the bounds of the calibration.

The calibration scales its residuals by the tolerances and requires them for success, so
the frozen scenario and every other that passes are equally good solutions. No wider limit has
a justification. Rows of a predictive controller are not used.

The ensemble has centres and rims of the admissible region, also with other assumptions;
docs/thesis/predictions.md states the choice.
"""

import dataclasses
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from ddct_bringup.reproduction.calibration.analysis import changed_assumptions
from ddct_bringup.reproduction.calibration.parameters import (
    PARAMETERS,
    RANGE,
    ROWS,
    Values,
    outside_tolerance,
    pi_growth_rate,
    residual_rows,
    values_of,
)
from ddct_bringup.reproduction.calibration.problem import Problem
from ddct_bringup.reproduction.calibration.record import member_text
from ddct_bringup.reproduction.calibration.record_types import ResidualEntry
from ddct_bringup.reproduction.calibration.search import WINDOW_ENDS_S, Progress, centre, rim
from ddct_bringup.reproduction.study_run import study_run
from ddct_bringup.thesis.predictions import folder_of_members
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import write_text
from ddct_plant.scenario.file import load_scenario, scenario_digest
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

QUANTITIES = {
    'level': ('torque level', (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    'rise': ('rise of the torque', (-RANGE[0] / RANGE[1], 1.0, 0.0, 0.0, 0.0, 0.0)),
    'rise_end': ('end of the rise', (0.0, 0.0, 1.0, 0.0, 0.0, 0.0)),
    'slope': ('slope of the reference', (0.0, 0.0, 0.0, 1.0, 0.0, 0.0)),
}
"""Quantities taken to their extremes, with directions in shares of the parameters' ranges."""
_DECIMALS = (2, 2, 4, 2, 5, 5)
"""Decimals of the values in the files, in the order of PARAMETERS."""


@cache
def members() -> tuple[Scenario, ...]:
    """Return the kept scenarios in the order of their names."""
    return members_in(folder_of_members())


def members_in(folder: Path) -> tuple[Scenario, ...]:
    """Return the scenarios in a folder in the order of their names."""
    return tuple(load_scenario(str(file)) for file in sorted(folder.glob('*.yaml')))


def why_not_admissible(scenario: Scenario) -> list[str]:
    """
    Return the violations of the rule by a scenario as text; none for an admissible one.

    Raise ParameterError for a scenario that is not of the calibrated kind.
    """
    values = values_of(scenario)
    against = [
        f'{parameter.name} {value:g} is outside {parameter.lower:g} to {parameter.upper:g}'
        for parameter, value in zip(PARAMETERS, values, strict=True)
        if not parameter.lower <= value <= parameter.upper
    ]
    growth = pi_growth_rate(scenario.driveline, *values[4:])
    if growth >= 0.0:
        against.append(f'the PI loop grows by {growth:.2g}/s')
    whole = {}
    for row, found in _row_values(scenario).items():
        missing = [name for name, value in found.items() if value is None]
        if missing:
            against.append(f'{row} has no {", ".join(missing)}')
        else:
            whole[row] = _defined(found)
    return against + outside_tolerance(residual_rows(whole))


def fitted_rows(scenario: Scenario) -> list[ResidualEntry]:
    """Return the nine values of the whole run, as in the record of the calibration."""
    values = _row_values(scenario).items()
    return residual_rows({row: _defined(found) for row, found in values})


def _row_values(scenario: Scenario) -> dict[str, dict[str, float | None]]:
    """Return the values of the fitted rows by name; None where one is undefined."""
    return {row: study_run(RunSettings(KnownSettings(scenario)), row).table_values for row in ROWS}


def _defined(values: Mapping[str, float | None]) -> dict[str, float]:
    return {name: value for name, value in values.items() if value is not None}


def find_members(frozen: Scenario, progress: Progress) -> list[Scenario]:
    """
    Search the ensemble from a calibrated scenario, and check every member against the rule.

    Raise DdctError for a member that the search found and the rule does not admit.
    """
    found: dict[str, Scenario] = {}
    for scenario in _search(frozen, progress):
        against = why_not_admissible(scenario)
        if against:
            raise DdctError(f'{scenario.name} is not admissible: {", ".join(against)}')
        # Two members are equal when they differ only in name and description.
        content = scenario_digest(dataclasses.replace(scenario, name=frozen.name, description=''))
        found.setdefault(content, scenario)
    return list(found.values())


def write_members(scenarios: list[Scenario], folder: Path) -> None:
    """Write one file per scenario, and remove the files of earlier members."""
    for file in folder.glob('*.yaml'):
        file.unlink()
    for scenario in scenarios:
        what = scenario.description
        head = (
            f'# An admissible scenario: {what[0].lower()}{what[1:]}.',
            '# Written by `ddct reproduce calibration --ensemble DIR`;'
            ' docs/thesis/predictions.md tells how.',
        )
        write_text(str(folder / f'{scenario.name}.yaml'), member_text(scenario, head))


def _search(frozen: Scenario, progress: Progress) -> Iterator[Scenario]:
    centres = _centres(frozen, progress)
    for end, at in centres.items():
        yield _member(
            Problem(end), at, f'window_{end:.1f}', f'Centre of the region, window to {end:.1f} s'
        )
    frozen_end = frozen.score_window_s[1]
    for end in (min(centres), frozen_end, max(centres)):
        for name, (quantity, direction) in QUANTITIES.items():
            progress(f'rim: {quantity}, score window to {end:.1f} s')
            for sign, which, extreme in ((-1.0, 'low', 'Lowest'), (1.0, 'high', 'Highest')):
                along = [sign * share for share in direction]
                yield _member(
                    Problem(end),
                    rim(Problem(end), centres[end], along),
                    f'window_{end:.1f}_{name}_{which}',
                    f'{extreme} {quantity}, window to {end:.1f} s',
                )
    for change, base in changed_assumptions().items():
        progress(f'centre: {change}')
        problem = Problem(frozen_end, base=base)
        at = centre(problem, centres[frozen_end])
        yield _member(
            problem, at, change.replace(' ', '_').replace('/', '_per_'), f'With {change}'
        )


def _centres(frozen: Scenario, progress: Progress) -> dict[float, tuple[float, ...]]:
    """Return the centre for each window end with an admissible one, starting from `frozen`."""
    start = frozen.score_window_s[1]
    before = [end for end in reversed(WINDOW_ENDS_S) if end < start]
    centres: dict[float, tuple[float, ...]] = {}
    for ends in ([start], before, [end for end in WINDOW_ENDS_S if end > start]):
        values: Values = centres[start] if centres else values_of(frozen)
        for end in ends:
            progress(f'centre: score window to {end:.1f} s')
            values = centre(Problem(end), values)
            if not why_not_admissible(_member(Problem(end), values, 'centre', '')):
                centres[end] = values
    return dict(sorted(centres.items()))


def _member(problem: Problem, at: Values, name: str, what: str) -> Scenario:
    values = [round(value, decimals) for value, decimals in zip(at, _DECIMALS, strict=True)]
    return dataclasses.replace(problem.scenario(values), name=name, description=what)
