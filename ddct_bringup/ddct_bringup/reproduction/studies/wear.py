# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Slip with a worn clutch and an unknown load, and the estimates of `mpc_wear`."""

import numpy as np

from ddct_bringup.reproduction.studies.changed_loops import NoisySpeeds, slip_after_load_step
from ddct_bringup.reproduction.studies.study import (
    FINER_WEAR_GAINS,
    TABLE_5_1,
    Study,
    run_study,
)
from ddct_bringup.reproduction.study_run import THESIS_SCENARIO, StudyRun, thesis_run
from ddct_controllers.interface import ControllerContext
from ddct_controllers.mpc.estimate.observer import NoiseLevels
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_controllers.registry import make_controller
from ddct_plant.base.timebase import PERIOD_S, steps_in
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.program.table import TextColumn
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

CONTROLLERS = (
    *('mpc3', 'mpc_preview', 'mpc_offset_free', 'mpc_torsion', 'mpc_wear'),
    *('hinf2', 'ls8'),
)
FAR_GAINS = (0.4, 0.7, 1.0, 1.3, 2.5)
"""Wear gains; the outer two are beyond the assumed range of a clutch."""
LOAD_STEP_N_M = 470.0
"""Load step at the wheels in N m: the start of a slope of 10 %."""
LOAD_STEP_S = 1.5
LAST_S = 0.5
"""Length in s of the last part of the run, in which the largest slip is evaluated."""
SEED = 4
CLOSE = 0.02
"""Relative error below which the wear gain counts as identified."""
_LOAD_STEP_REMARK = f'The load step is {LOAD_STEP_N_M:g} N m at the wheels at {LOAD_STEP_S:g} s.'
_LOAD_STEP = LOAD_STEP_N_M, steps_in('load step', LOAD_STEP_S)


def wear() -> Study:
    """Run the controllers at every wear gain, in the detailed architecture."""
    return _study(
        'detailed',
        FINER_WEAR_GAINS,
        'C_fOL is wrong by the wear gain, and no feedback acts before 0.6 s: that is where the '
        'slip at 0.6 s comes from, and t_a grows with it.',
    )


def wear_feedforward() -> Study:
    """Run the controllers worn in the architecture of Figure 5.1, with feedback from the start."""
    return _study(
        'feedforward', FAR_GAINS, 'Feedback acts from 0 s, so slip is controlled at 0.6 s.'
    )


def _study(architecture: str, wear_gains: tuple[float, ...], remark: str) -> Study:
    return run_study(
        f'Worn clutch and unknown load in the thesis scenario, {architecture}',
        ('controller', 'K_usura'),
        (
            TextColumn('w_d at 0.6 s rpm', '.0f', lambda run: run.slip_rpm[run.start]),
            *TABLE_5_1,
            TextColumn('w_d at the end rpm', 'z.2f', lambda run: run.slip_rpm[-1]),
            TextColumn('largest in last 0.5 s', '.2f', _largest_in_last_part),
            TextColumn('after load step', 'z.2f', _after_load_step),
        ),
        [
            ((name, f'{gain:g}'), thesis_run(name, architecture, gain))
            for name in CONTROLLERS
            for gain in wear_gains
        ],
        (remark, _LOAD_STEP_REMARK, '"after load step" is w_d at the end with it, in rpm.'),
    )


def _largest_in_last_part(run: StudyRun) -> float:
    return float(np.abs(run.slip_rpm[-steps_in('last', LAST_S) :]).max())


def _after_load_step(run: StudyRun) -> float:
    controller = make_controller(str(run.controller), run.settings.known)
    return rpm_from_rad_s(slip_after_load_step(run.settings, controller, *_LOAD_STEP)[-1])


def wear_estimate() -> Study:
    """Run `mpc_wear` with exact and with noisy speeds, with a load step."""
    noise = NoiseLevels().speed_rad_s
    return Study(
        'Estimate of K_usura in the thesis scenario, with a load step',
        (
            'K_usura',
            'noise on speeds rad/s',
            f'within {CLOSE:g} from s',
            'rms error after 0.6 s',
            'largest error after 0.6 s',
            'w_d at the end rpm',
        ),
        [_estimate_row(gain, level) for level in (0.0, noise) for gain in FINER_WEAR_GAINS],
        (
            _LOAD_STEP_REMARK,
            'Torque flows from about 0.05 s on; the noise is the standard deviation that the '
            'filter assumes, drawn with a fixed seed.',
        ),
    )


def _estimate_row(wear_gain: float, noise_rad_s: float) -> tuple[str, ...]:
    settings = RunSettings(KnownSettings(THESIS_SCENARIO), CaseSettings(wear_gain=wear_gain))
    controller = PREDICTIVE['mpc_wear'](ControllerContext(settings.known, {}))
    gains: list[float] = []
    slip = slip_after_load_step(
        settings,
        NoisySpeeds(controller, noise_rad_s, SEED),
        *_LOAD_STEP,
        each_step=lambda: gains.append(controller.observer.wear_gain),
    )
    error = np.array(gains) - wear_gain
    controlled = error[settings.scenario.control_start_step :]
    outside = np.flatnonzero(np.abs(error) > CLOSE)
    return (
        f'{wear_gain:g}',
        f'{noise_rad_s:g}',
        f'{(outside[-1] + 1 if outside.size else 0) * PERIOD_S:.2f}',
        f'{np.sqrt(np.mean(controlled**2)):.4f}',
        f'{np.abs(controlled).max():.4f}',
        f'{rpm_from_rad_s(slip[-1]):z.2f}',
    )
