# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Study: how much a change of the calibrated scenario moves the predicted rows of the thesis."""

from collections.abc import Mapping, Sequence

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.reproduction.numbers.thesis_number import Finding
from ddct_bringup.reproduction.studies.study import TABLE_5_1, Study, cells
from ddct_bringup.reproduction.study_run import StaticControllerAlone, StudyRun, study_run
from ddct_bringup.reproduction.values.orders import (
    WORN,
    judge_table_5_2,
    rows_of_table_5_2,
    runs_of_table_5_2,
)
from ddct_bringup.thesis.table_5_1 import CALIBRATED, PREDICTED_ROWS, THESIS_TABLE, ThesisRow
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_plant.program.table import Weight
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

CHANGES: Mapping[str, Sequence[str]] = {
    'none': (),
    'level of C_m +30 N m': ('engine.torque_n_m=[30.0, 338.0]',),
    'rise of C_m -5 %': ('engine.torque_n_m=[0.0, 292.6]',),
    'rise of C_m +5 %': ('engine.torque_n_m=[0.0, 323.4]',),
    'end of the rise -5 %': ('engine.time_s=[0.0, 0.498]',),
    'end of the rise +5 %': ('engine.time_s=[0.0, 0.550]',),
    'slope of the reference -5 %': ('reference.slope_rad_s2=108.3',),
    'slope of the reference +5 %': ('reference.slope_rad_s2=119.7',),
    'score window to 1.6 s': ('score_window_s=[0.6, 1.6]',),
    'score window to 1.8 s': ('score_window_s=[0.6, 1.8]',),
    'score window to 3.0 s': ('score_window_s=[0.6, 3.0]',),
    'road load times 0.5': ('load.rolling_coefficient=0.005', 'load.drag_coefficient=0.16'),
    'road load times 1.5': ('load.rolling_coefficient=0.015', 'load.drag_coefficient=0.48'),
    'both plates at 120 rad/s': (
        *('initial.engine_speed_rad_s=120.0', 'initial.shaft_speed_rad_s=120.0'),
    ),
    'both plates at 200 rad/s': (
        *('initial.engine_speed_rad_s=200.0', 'initial.shaft_speed_rad_s=200.0'),
    ),
}
"""Changes of the scenario `thesis`, one at a time, as settings of its keys."""
FITTED_ROWS = [row for row in THESIS_TABLE if row.use == CALIBRATED]


def scenario_changes() -> Study:
    """Return the predicted rows of Table 5.1, and the words of Table 5.2 that hold, by change."""
    scenarios = {name: load_scenario('thesis', changes) for name, changes in CHANGES.items()}
    runs = {name: _runs(scenario) for name, scenario in scenarios.items()}
    headings = [column.heading for column in TABLE_5_1]
    return Study(
        'Predicted rows by change of the scenario',
        (
            *('change', 'fit, tolerances'),
            *(f'{row.label} {heading}' for row in PREDICTED_ROWS for heading in headings),
            *('C_fOL alone std w_sr rpm', 'words of Table 5.2 that hold'),
        ),
        [
            (
                name,
                _largest_deviation(runs[name]),
                *(
                    cell
                    for row in PREDICTED_ROWS
                    for cell in cells(TABLE_5_1, runs[name][row.controller])
                ),
                cells(TABLE_5_1, _without_feedback(scenario))[1],
                _words_that_hold(scenario),
            )
            for name, scenario in scenarios.items()
        ],
        (
            '"fit" is the largest deviation of the nine fitted figures; above 1 it is no fit.',
            *(_hits(row, runs) for row in PREDICTED_ROWS),
        ),
        weights=(Weight.IDENTIFYING,),
    )


def _runs(scenario: Scenario) -> dict[str, StudyRun]:
    """Return the runs of the controllers of Table 5.1 by name."""
    settings = RunSettings(KnownSettings(scenario))
    return {row.controller: study_run(settings, row.controller) for row in THESIS_TABLE}


def _without_feedback(scenario: Scenario) -> StudyRun:
    return study_run(RunSettings(KnownSettings(scenario)), StaticControllerAlone())


def _largest_deviation(runs: Mapping[str, StudyRun]) -> str:
    """Return the largest of the nine fitted values, '-' where one is undefined."""
    deviations = [
        deviation
        for row in FITTED_ROWS
        for deviation in row.scaled_deviations(runs[row.controller].table_values).values()
    ]
    defined = [abs(deviation) for deviation in deviations if deviation is not None]
    return f'{max(defined):.2f}' if len(defined) == len(deviations) else '-'


def _words_that_hold(scenario: Scenario) -> str:
    findings: list[Finding] = []
    for gain in WORN:
        rows = rows_of_table_5_2(runs_of_table_5_2(scenario, gain))
        findings += judge_table_5_2(gain, rows).values()
    return f'{sum(finding.holds for finding in findings)} of {len(findings)}'


def _hits(row: ThesisRow, runs: Mapping[str, Mapping[str, StudyRun]]) -> str:
    """Return in how many scenarios a row is near the print in all its values, and in each."""
    near = [
        [row.hit(name, value) for name, value in found[row.controller].table_values.items()]
        for found in runs.values()
    ]
    whole = sum(all(values) for values in near)
    each = ', '.join(
        f'{METRICS[name].symbol} in {sum(values)}'
        for name, values in zip(TABLE_METRICS, zip(*near, strict=True), strict=True)
    )
    return (
        f'{row.label}: {whole} of the {len(near)} scenarios hit all three figures at once; '
        f'{each} of them.'
    )
