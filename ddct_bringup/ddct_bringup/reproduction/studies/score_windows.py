"""What the rows of MPC3 and MPC4 become by the end of the score window."""

import dataclasses

from ddct_bringup.reproduction.calibration.admissible import fitted_rows
from ddct_bringup.reproduction.calibration.ensemble import members
from ddct_bringup.reproduction.calibration.parameters import largest_residual, values_of
from ddct_bringup.reproduction.calibration.problem import Problem, fit
from ddct_bringup.reproduction.runs import THESIS_SCENARIO, StaticControllerAlone
from ddct_bringup.reproduction.studies.readings import READINGS
from ddct_bringup.reproduction.studies.study import (
    TABLE_5_1,
    Study,
    StudyRun,
    cells,
    study_run,
)
from ddct_bringup.thesis.table_5_1 import (
    ROW_OF,
)
from ddct_controllers.mpc.costs import TABLE_4_1
from ddct_controllers.mpc.estimators import FULL
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings

_PER_RAD_S = READINGS['Q per rad/s, noise as it is']
_MORE_KNOWN = dataclasses.replace(
    _PER_RAD_S, knowledge=dataclasses.replace(FULL, delay_in_model=False)
)


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
            'the same, told w_m, w_p, w_r and C_load',
            'mpc4',
            'C_fOL alone, std w_sr rpm',
        ),
        [
            *(_window_row(label, scenario) for label, scenario in scenarios),
            ('-', 'as the thesis prints it', '-', '-', *3 * [_print('mpc3')], _print('mpc4'), '-'),
        ],
        ('A controller has t_a in s / std w_sr in rpm / std A_x in m/s^2.',),
    )


def _window_row(label: str, scenario: Scenario) -> tuple[str, ...]:
    fitted = fitted_rows(scenario)
    settings = RunSettings(scenario)
    return (
        f'{scenario.score_window_s[1]:.1f}',
        label,
        f'{max(abs(row["deviation"]) for row in fitted):.1%}'.rstrip('%'),
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
