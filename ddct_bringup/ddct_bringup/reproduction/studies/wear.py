"""What a worn clutch and an unknown load leave of the slip: Table 5.2 in numbers."""

import numpy as np

from ddct_bringup.reproduction.runs.runs import THESIS_SCENARIO
from ddct_bringup.reproduction.studies.disturbed_run import slip_after_load_step
from ddct_bringup.reproduction.studies.scored_run import FIGURE_HEADERS, figures, metrics_of
from ddct_bringup.reproduction.studies.study import Study
from ddct_bringup.run.headless import run_headless
from ddct_controllers.registry import make_controller
from ddct_plant.base.timebase import steps_in
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.settings import RunSettings

CONTROLLERS = (
    'mpc3',
    'mpc_preview',
    'mpc_offset_free',
    'mpc_torsion',
    'mpc_wear',
    'hinf2',
    'ls8',
)
WEAR_GAINS = (0.7, 0.85, 1.0, 1.15, 1.3)
FAR_GAINS = (0.4, 0.7, 1.0, 1.3, 2.5)
"""The outer two are beyond what a clutch is taken to reach."""
LOAD_STEP_N_M = 470.0
"""At the wheels: a slope of 10 % begins."""
LOAD_STEP_S = 1.5
LAST_S = 0.5
"""Of the run, in which the largest slip is looked for."""


_REMARK = (
    f'The load step is {LOAD_STEP_N_M:g} N m at the wheels at {LOAD_STEP_S:g} s; its column is '
    'w_d at the end in rpm.'
)


def wear() -> Study:
    """Run the controllers at every wear gain in the detailed architecture."""
    return _study(
        'detailed',
        WEAR_GAINS,
        'C_fOL is wrong by the wear gain, and no feedback acts before 0.6 s: that is where the '
        'slip at 0.6 s comes from, and t_a grows with it.',
    )


def wear_feedforward() -> Study:
    """Do the same in the architecture of Figure 5.1, where feedback acts from the start."""
    return _study(
        'feedforward', FAR_GAINS, 'Feedback acts from 0 s, so slip is controlled at 0.6 s.'
    )


def _study(architecture: str, wear_gains: tuple[float, ...], remark: str) -> Study:
    return Study(
        title=f'Worn clutch and unknown load in the thesis scenario, {architecture}',
        headers=(
            'controller',
            'K_usura',
            'w_d at 0.6 s rpm',
            *FIGURE_HEADERS,
            'w_d at the end rpm',
            'largest in last 0.5 s',
            'after load step',
        ),
        rows=[
            _row(name, RunSettings(THESIS_SCENARIO, architecture, wear_gain=gain))
            for name in CONTROLLERS
            for gain in wear_gains
        ],
        remarks=(remark, _REMARK),
    )


def _row(name: str, settings: RunSettings) -> tuple[str, ...]:
    trajectory = run_headless(settings, name)
    slip_rpm = rpm_from_rad_s(1.0) * trajectory.slip_speed
    stepped = slip_after_load_step(
        settings,
        make_controller(name, settings),
        LOAD_STEP_N_M,
        steps_in('load step', LOAD_STEP_S),
    )
    return (
        name,
        f'{settings.wear_gain:g}',
        f'{slip_rpm[settings.scenario.control_start_step]:.0f}',
        *figures(metrics_of(settings, trajectory)),
        f'{slip_rpm[-1]:z.2f}',
        f'{np.abs(slip_rpm[-steps_in("last", LAST_S) :]).max():.2f}',
        f'{rpm_from_rad_s(stepped[-1]):z.2f}',
    )
