# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Studies of the admissible scenarios: fitted values, predictions, readings of the MPC rows."""

import dataclasses

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.reproduction.calibration.ensemble import fitted_rows, members
from ddct_bringup.reproduction.calibration.parameters import largest_residual, values_of
from ddct_bringup.reproduction.calibration.predicted_values import OPEN_LOOP
from ddct_bringup.reproduction.calibration.problem import Problem, fit
from ddct_bringup.reproduction.studies.readings import READINGS
from ddct_bringup.reproduction.studies.study import (
    AS_PRINTED,
    TABLE_5_1,
    Study,
    cells,
    identified_by,
)
from ddct_bringup.reproduction.study_run import (
    THESIS_SCENARIO,
    StaticControllerAlone,
    StudyRun,
    study_run,
)
from ddct_bringup.reproduction.values.orders import OSCILLATION_RATINGS, SLIP_RATINGS, WORN
from ddct_bringup.thesis.predictions import Prediction, kept_predictions
from ddct_bringup.thesis.table_5_1 import FORMS, PREDICTED_ROWS, ROW_OF, ThesisRow
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_controllers.mpc.costs import TABLE_4_1
from ddct_controllers.mpc.estimators import FULL
from ddct_plant.program.table import text_or_dash
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

_PER_RAD_S = READINGS['Q per rad/s, noise as it is']
_MORE_KNOWN = dataclasses.replace(
    _PER_RAD_S, knowledge=dataclasses.replace(FULL, delay_in_model=False)
)


def admissible_scenarios() -> Study:
    """Return the fitted values of each admissible scenario and the quality of its fit."""
    return Study(
        'Admissible scenarios',
        (
            *('scenario', 'window to s', 'C_m start N m', 'rise N m', 'rise end s'),
            *('slope rad/s^2', 'K_p', 'K_i', 'largest residual, tolerances'),
        ),
        [_scenario_row(one) for one in (THESIS_SCENARIO, *members())],
    )


def _scenario_row(scenario: Scenario) -> tuple[str, ...]:
    start, end, rise_end, slope, proportional, integral = values_of(scenario)
    return (
        scenario.name,
        f'{scenario.score_window_s[1]:.1f}',
        f'{start:.1f}',
        f'{end - start:.1f}',
        f'{rise_end:.3f}',
        f'{slope:.1f}',
        f'{proportional:.3f}',
        f'{integral:.4f}',
        f'{largest_residual(fitted_rows(scenario)):.2f}',
    )


def prediction_ranges() -> Study:
    """Return the MPC rows of Table 5.1 as value and range with the printed value."""
    rows = []
    for row in PREDICTED_ROWS:
        for name, printed in row.printed_values().items():
            found = _kept(f'5.1 {row.controller} {name}')
            assert not isinstance(found.frozen, str)
            rows.append(
                (
                    *(row.label, METRICS[name].heading),
                    *_value_and_range(found, FORMS[name]),
                    f'{printed:.2f}',
                    row.verdict(name, found.frozen),
                    'yes' if found.contains(printed) else 'no',
                )
            )
    for name in TABLE_METRICS[1:]:
        alone = _kept(f'5.1 {OPEN_LOOP} {name}')
        cells_of_value = _value_and_range(alone, FORMS[name])
        rows.append((OPEN_LOOP, METRICS[name].heading, *cells_of_value, '-', '-', '-'))
    return Study(
        'Predicted figures of Table 5.1',
        ('row', 'figure', 'value', 'range', 'printed', 'verdict', 'print within the range'),
        rows,
        (
            "The end '-' of a range: some scenarios have no t_a, as w_d does not reach zero.",
            *(_hits_at_once(row) for row in PREDICTED_ROWS),
        ),
        weights=identified_by(2),
    )


def _hits_at_once(row: ThesisRow) -> str:
    """Return the number of scenarios with hits for all values of a row, and for its sigmas."""
    values = [_kept(f'5.1 {row.controller} {name}').values for name in TABLE_METRICS]
    hits = [
        [row.hit(name, value) for name, value in zip(TABLE_METRICS, figures, strict=True)]
        for figures in zip(*values, strict=True)
    ]
    return (
        f'{row.label}: of {len(hits)} scenarios {sum(all(one) for one in hits)} hit all three '
        f'figures at once, {sum(all(one[1:]) for one in hits)} both standard deviations.'
    )


def worn_ranges() -> Study:
    """Return hit or miss for the ratings of Table 5.2, and their numbers, with their ranges."""
    rows: list[tuple[str, ...]] = []
    for gain in WORN:
        for name in SLIP_RATINGS:
            kinds = (
                ('w_d', f'w_d "{SLIP_RATINGS[name]}"', ''),
                ('slip_rad_s', '|w_d| at the end of the window rad/s', '.1f'),
                ('w_sr', f'w_sr, A_x "{OSCILLATION_RATINGS[gain][name]}"', ''),
                *(
                    (figure, METRICS[figure].heading, FORMS[figure])
                    for figure in TABLE_METRICS[1:]
                ),
            )
            for kind, header, form in kinds:
                found = _kept(f'5.2 {name} {kind} {gain:g}')
                rows.append((name, f'{gain:g}', header, *_value_and_range(found, form)))
    return Study(
        'Table 5.2, value and range',
        ('controller', 'K_usura', 'word or figure', 'value', 'range'),
        rows,
        ('A verdict on a word has beside it in how many of the scenarios it is that.',),
        weights=identified_by(3),
    )


def _kept(name: str) -> Prediction:
    return kept_predictions().predictions[name]


def _value_and_range(found: Prediction, form: str) -> tuple[str, str]:
    return text_or_dash(found.frozen, form), found.text(form)


def score_windows() -> Study:
    """Return MPC3, MPC4 and C_fOL alone for each end of the score window."""
    centres = [one for one in members() if one.name == f'window_{one.score_window_s[1]:.1f}']
    longest = max(centres, key=lambda one: one.score_window_s[1])
    whole_run = fit(Problem(longest.score_window_s[1]), values_of(longest))
    scenarios = [
        ('frozen', THESIS_SCENARIO),
        *(('centre', one) for one in centres),
        ('least squares', whole_run.problem.scenario(whole_run.values)),
    ]
    return Study(
        'The MPC rows by the end of the score window',
        (
            'window to s',
            'fit',
            'largest deviation of the nine %',
            'in tolerances',
            'mpc3',
            'mpc3, Q per rad/s',
            'the same, with w_m, w_p, w_r and C_load',
            'mpc4',
            'C_fOL alone, std w_sr rpm',
        ),
        [
            *(_window_row(label, scenario) for label, scenario in scenarios),
            ('-', AS_PRINTED, '-', '-', *3 * [_print('mpc3')], _print('mpc4'), '-'),
        ],
        ('A controller has t_a in s / std w_sr in rpm / std A_x in m/s^2.',),
        weights=identified_by(2),
    )


def _window_row(label: str, scenario: Scenario) -> tuple[str, ...]:
    fitted = fitted_rows(scenario)
    settings = RunSettings(KnownSettings(scenario))
    return (
        f'{scenario.score_window_s[1]:.1f}',
        label,
        f'{max(abs(row.deviation) for row in fitted):.1%}'.rstrip('%'),
        f'{largest_residual(fitted):.2f}',
        _cell(study_run(settings, 'mpc3')),
        _cell(_PER_RAD_S.run(TABLE_4_1['mpc3'], scenario)),
        _cell(_MORE_KNOWN.run(TABLE_4_1['mpc3'], scenario)),
        _cell(study_run(settings, 'mpc4')),
        cells(TABLE_5_1, study_run(settings, StaticControllerAlone()))[1],
    )


def _cell(run: StudyRun) -> str:
    return ' / '.join(cells(TABLE_5_1, run))


def _print(controller: str) -> str:
    return ' / '.join(ROW_OF[controller].cells())
