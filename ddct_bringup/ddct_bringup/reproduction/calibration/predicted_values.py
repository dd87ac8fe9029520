# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Predictions of a scenario for the thesis's other results, by the ids of the thesis gate.

They took no part in the fit: the MPC rows of Table 5.1 and the whole of Table 5.2. For a
qualitative rating of Table 5.2 the prediction is hit or miss, with the numbers behind it.
"""

from collections.abc import Iterable

from ddct_bringup.reproduction.calibration.search import Progress
from ddct_bringup.reproduction.study_run import StaticControllerAlone, study_run
from ddct_bringup.reproduction.values.orders import (
    SLIP_RATINGS,
    WORN,
    WORN_ARCHITECTURE,
    judge_table_5_2,
    rows_of_table_5_2,
)
from ddct_bringup.thesis.predictions import Prediction, Predictions, Value
from ddct_bringup.thesis.table_5_1 import PREDICTED_ROWS
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_plant.scenario.file import scenario_digest
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

OPEN_LOOP = 'C_fOL alone'
"""
Name in place of a controller: the clutch has C_fOL alone, and the engine the driver's demand.
"""


def predict(frozen: Scenario, members: Iterable[Scenario], progress: Progress) -> Predictions:
    """Return every prediction for the frozen scenario, with its values in the members."""
    progress(f'predictions of {frozen.name}')
    of_frozen = predicted_values(frozen)
    found: dict[str, dict[str, Value]] = {}
    for member in members:
        progress(f'predictions of {member.name}')
        found[member.name] = predicted_values(member)
    return Predictions(
        scenario_digest(frozen),
        {
            name: Prediction(value, {member: values[name] for member, values in found.items()})
            for name, value in of_frozen.items()
        },
    )


def predicted_values(scenario: Scenario) -> dict[str, Value]:
    """Return every predicted value of a scenario by its id."""
    found = _table_5_1(scenario)
    for wear_gain in WORN:
        found |= _table_5_2(scenario, wear_gain)
    return found


def _table_5_1(scenario: Scenario) -> dict[str, Value]:
    settings = RunSettings(KnownSettings(scenario))
    runs = {row.controller: study_run(settings, row.controller) for row in PREDICTED_ROWS}
    runs[OPEN_LOOP] = study_run(settings, StaticControllerAlone())
    return {
        f'5.1 {name} {figure}': value
        for name, run in runs.items()
        for figure, value in run.table_values.items()
    }


def _table_5_2(scenario: Scenario, wear_gain: float) -> dict[str, Value]:
    settings = RunSettings(
        KnownSettings(scenario, WORN_ARCHITECTURE), CaseSettings(wear_gain=wear_gain)
    )
    runs = {name: study_run(settings, name) for name in SLIP_RATINGS}
    rows = rows_of_table_5_2(runs)
    found: dict[str, Value] = {
        name: 'hit' if finding.holds else 'miss'
        for name, finding in judge_table_5_2(wear_gain, rows).items()
    }
    for name, run in runs.items():
        found[f'5.2 {name} slip_rad_s {wear_gain:g}'] = rows[0][name]
        found |= {
            f'5.2 {name} {what} {wear_gain:g}': run.table_values[what]
            for what in TABLE_METRICS[1:]
        }
    return found
