"""What the thesis cites as the state of the art, in its scenario and beside its controllers."""

from dataclasses import replace

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.reproduction.runs.runs import THESIS_SCENARIO
from ddct_bringup.reproduction.studies.scored_run import FIGURE_HEADERS, figures, metrics_of
from ddct_bringup.reproduction.studies.study import Study
from ddct_bringup.run.headless import run_headless
from ddct_controllers.interface import ControllerContext
from ddct_controllers.state_of_art.controllers import STATE_OF_ART
from ddct_controllers.state_of_art.pedal_mpc import engagement_time_s
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rad_s_from_rpm, rpm_from_rad_s
from ddct_plant.program.table import text_or_dash
from ddct_plant.scenario.settings import RunSettings

BESIDE = ('pi', 'hinf1', 'mpc3')
WEAR_GAINS = (0.7, 1.0, 1.3)
PEDAL_POSITIONS = (0.0, 0.25, 0.5, 0.75, 1.0)
SETTLED_RPM = 10.0
_SETTLED_HEADER = f'within {SETTLED_RPM:g} rpm s'
_REMARK = (
    f'"within {SETTLED_RPM:g} rpm" is the time from control start after which |w_d| stays below '
    'that; a dash in t_a means that w_d did not change its sign.'
)


def state_of_art() -> Study:
    """Run them new and worn in the detailed architecture."""
    return Study(
        title='The state of the art in the thesis scenario, detailed',
        headers=(
            'controller',
            'K_usura',
            *FIGURE_HEADERS,
            _SETTLED_HEADER,
            'w_d at the end rpm',
            'largest C_m less demand N m',
        ),
        rows=[
            _row(name, RunSettings(THESIS_SCENARIO, wear_gain=gain))
            for name in (*BESIDE, *STATE_OF_ART)
            for gain in WEAR_GAINS
        ],
        remarks=(
            _REMARK,
            'Where C_m leaves the demand the controller commands the engine too; compare such a '
            'row with mpc4 rather than with those of one input.',
        ),
    )


def pedal_positions() -> Study:
    """Run `pedal_mpc` at several pedal positions."""
    rows = []
    for position in PEDAL_POSITIONS:
        settings = RunSettings(replace(THESIS_SCENARIO, pedal_position=position))
        trajectory = run_headless(settings, 'pedal_mpc')
        rows.append(
            (
                f'{position:g}',
                f'{engagement_time_s(ControllerContext(settings, {})):.2f}',
                *figures(metrics_of(settings, trajectory)),
                text_or_dash(settled_s(settings, trajectory), '.2f'),
            )
        )
    return Study(
        title='pedal_mpc in the thesis scenario, by the position of the pedal',
        headers=('pedal_position', 't_f s', *FIGURE_HEADERS, _SETTLED_HEADER),
        rows=rows,
        remarks=(_REMARK,),
    )


def _row(name: str, settings: RunSettings) -> tuple[str, ...]:
    trajectory = run_headless(settings, name)
    deviation = np.abs(trajectory.engine_torque - trajectory.torque_demand).max()
    return (
        name,
        f'{settings.wear_gain:g}',
        *figures(metrics_of(settings, trajectory)),
        text_or_dash(settled_s(settings, trajectory), '.2f'),
        f'{rpm_from_rad_s(trajectory.slip_speed[-1]):z.2f}',
        f'{deviation:.0f}',
    )


def settled_s(settings: RunSettings, trajectory: Trajectory) -> float | None:
    """Return after which time in s from control start |w_d| stays small; None if it does not."""
    start = settings.scenario.control_start_step
    outside = np.abs(trajectory.slip_speed[start:]) >= rad_s_from_rpm(SETTLED_RPM)
    if outside[-1]:
        return None
    return PERIOD_S * int(np.flatnonzero(outside)[-1] + 1) if outside.any() else 0.0
