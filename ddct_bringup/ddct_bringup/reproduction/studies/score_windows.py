"""What the end of the score window, which the thesis does not name, decides of its MPC rows."""

import dataclasses

from ddct_bringup.reproduction.calibration.admissible import fitted_rows
from ddct_bringup.reproduction.calibration.ensemble import members
from ddct_bringup.reproduction.calibration.problem import Problem, fit
from ddct_bringup.reproduction.calibration.record import values_of
from ddct_bringup.reproduction.runs.runs import THESIS_SCENARIO
from ddct_bringup.reproduction.studies.readings import READINGS
from ddct_bringup.reproduction.studies.scored_run import figures, scored_run
from ddct_bringup.reproduction.studies.static_controller import StaticControllerAlone
from ddct_bringup.reproduction.studies.study import Study
from ddct_bringup.scores.metrics import Metrics
from ddct_bringup.thesis.table_5_1 import thesis_row
from ddct_controllers.mpc.costs import TABLE_4_1
from ddct_controllers.mpc.knowledge import FULL
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings

_PER_RAD_S = READINGS['Q per rad/s, noise as it is']
_MORE_KNOWN = dataclasses.replace(
    _PER_RAD_S, knowledge=dataclasses.replace(FULL, delay_in_model=False)
)
_CENTRE, _FROZEN, _LEAST_SQUARES = 'centre', 'frozen', 'least squares'


def score_windows() -> Study:
    """Return MPC3, MPC4 and C_fOL alone for each end of the score window."""
    centres = [one for one in members() if one.name == f'window_{one.score_window_s[1]:.1f}']
    longest = max(centres, key=lambda one: one.score_window_s[1])
    whole_run = fit(Problem(longest.score_window_s[1]), values_of(longest))
    scenarios = [
        (_FROZEN, THESIS_SCENARIO),
        *((_CENTRE, one) for one in centres),
        (_LEAST_SQUARES, whole_run.problem.scenario(whole_run.values)),
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
            'the same, told w_m, w_p, w_r and C_load',
            'mpc4',
            'C_fOL alone, std w_sr rpm',
        ),
        [
            *(_row(label, scenario) for label, scenario in scenarios),
            ('-', 'as the thesis prints it', '-', '-', *3 * [_print('mpc3')], _print('mpc4'), '-'),
        ],
        ('A controller has t_a in s / std w_sr in rpm / std A_x in m/s^2.',),
    )


def _row(label: str, scenario: Scenario) -> tuple[str, ...]:
    fitted = fitted_rows(scenario)
    settings = RunSettings(scenario)
    alone = scored_run(settings, StaticControllerAlone())
    return (
        f'{scenario.score_window_s[1]:.1f}',
        label,
        f'{max(abs(row["deviation"]) for row in fitted):.1%}'.rstrip('%'),
        f'{max(abs(row["deviation"]) / row["tolerance"] for row in fitted):.2f}',
        _cell(scored_run(settings, 'mpc3')),
        _cell(_PER_RAD_S.score(TABLE_4_1['mpc3'], scenario)),
        _cell(_MORE_KNOWN.score(TABLE_4_1['mpc3'], scenario)),
        _cell(scored_run(settings, 'mpc4')),
        figures(alone)[1],
    )


def _cell(metrics: Metrics) -> str:
    return ' / '.join(figures(metrics))


def _print(controller: str) -> str:
    row = thesis_row(controller)
    assert row is not None
    return ' / '.join(format(value, 'g') for value in row.figures().values())
