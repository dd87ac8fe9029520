# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Studies that vary a weight, the wear, the pedal, or the authority over the engine."""

from dataclasses import replace

import numpy as np

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.reproduction.studies.study import (
    CLOSE_RPM,
    TABLE_5_1,
    TWO_INPUTS,
    WEAR_GAINS,
    Study,
    close_column,
    friction_kj,
    metric_column,
    run_study,
)
from ddct_bringup.reproduction.study_run import (
    SLIP_ERROR,
    THESIS_SCENARIO,
    StudyRun,
    study_run,
    thesis_run,
)
from ddct_controllers.interface import ControllerContext
from ddct_controllers.mpc.costs import BASIS, default_torsion_weight
from ddct_controllers.state_of_art.controllers import STATE_OF_ART
from ddct_controllers.state_of_art.pedal_mpc import engagement_time_s
from ddct_plant.models.engine import EngineAuthority
from ddct_plant.program.table import TextColumn, Weight
from ddct_plant.scenario.settings import KnownSettings, RunSettings

TORSION_FACTORS = (0.0, 1.0, 3.0, 6.0, 12.0, 20.0, 40.0)
"""Weights of w_sr per rpm as multiples of that of w_d, besides the default."""
DEFAULT_FACTOR = default_torsion_weight(THESIS_SCENARIO.driveline.gear) / BASIS.output_weight
BESIDE = ('pi', 'hinf1', 'mpc3')
"""Controllers of the thesis for comparison with the cited ones."""
_FINE_GAINS = (0.7, 0.85, 0.95, 1.0, 1.05, 1.15, 1.3)
TWO_INPUT_GAINS = {'mpc4': _FINE_GAINS, 'mpc4_wear': (0.4, 0.5, *_FINE_GAINS, 1.5, 1.6, 2.0)}
"""
Wear gains by controller; those of `mpc4_wear` exceed the bounds of its estimate, 0.5 and 1.5.
"""
AUTHORITIES = {
    'free': EngineAuthority(),
    **{
        f'{limit:g} N m': EngineAuthority(deviation_n_m=limit)
        for limit in (40.0, 30.0, 20.0, 10.0, 5.0, 0.0)
    },
    **{
        f'{rate:g} N m/s': EngineAuthority(slew_n_m_s=rate)
        for rate in (2000.0, 1000.0, 500.0, 200.0, 100.0)
    },
    **{
        f'lag {1000.0 * lag:g} ms': EngineAuthority(lag_s=lag)
        for lag in (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)
    },
}
_SETTLED = close_column(f'within {CLOSE_RPM:g} rpm s')
_SETTLED_REMARK = (
    f'"within {CLOSE_RPM:g} rpm" is the time from control start after which |w_d| stays below '
    'that; a dash in t_a means that w_d did not change its sign.'
)


def torsion_weight() -> Study:
    """Run `mpc_torsion` over its weight."""
    return run_study(
        'mpc_torsion over the weight of w_sr, thesis scenario',
        ('weight per rpm', 'times that of w_d'),
        (
            *TABLE_5_1,
            metric_column(SLIP_ERROR, '.2f', 'slip RMSE rpm'),
            metric_column(METRICS['slip_final_rpm'], 'z.2f', 'w_d at the end rpm'),
        ),
        [_torsion_case(factor) for factor in sorted((*TORSION_FACTORS, DEFAULT_FACTOR))],
        (
            f'The default is the total ratio, {DEFAULT_FACTOR:.3f}, times the weight of w_d; '
            '0 is mpc_offset_free.',
            'Where the slip RMSE is large, slip runs ahead of its reference: t_a then shrinks for '
            'the wrong reason.',
        ),
    )


def _torsion_case(factor: float) -> tuple[tuple[str, str], StudyRun]:
    weight = factor * BASIS.output_weight
    options = {**THESIS_SCENARIO.controllers, 'mpc_torsion': {'torsion_weight': weight}}
    settings = RunSettings(KnownSettings(replace(THESIS_SCENARIO, controllers=options)))
    label = f'{weight:.2f}' + (' (default)' if factor == DEFAULT_FACTOR else '')
    return (label, f'{factor:.3g}'), study_run(settings, 'mpc_torsion')


def state_of_art() -> Study:
    """Run the controllers that the thesis cites, and three of its own, new and worn, detailed."""
    return run_study(
        'The state of the art in the thesis scenario, detailed',
        ('controller', 'K_usura'),
        (
            *TABLE_5_1,
            _SETTLED,
            TextColumn('w_d at the end rpm', 'z.2f', lambda run: run.slip_rpm[-1]),
            TextColumn('largest C_m less demand N m', '.0f', _largest_deviation),
        ),
        [
            ((name, f'{gain:g}'), thesis_run(name, 'detailed', gain))
            for name in (*BESIDE, *STATE_OF_ART)
            for gain in WEAR_GAINS
        ],
        (
            _SETTLED_REMARK,
            'Where C_m leaves the demand the controller commands the engine too; compare such a '
            'row with mpc4 rather than with those of one input.',
        ),
    )


def _largest_deviation(run: StudyRun) -> float:
    return float(np.abs(run.trajectory.engine_torque - run.trajectory.torque_demand).max())


def pedal_positions() -> Study:
    """Run `pedal_mpc` at several pedal positions."""
    every = {
        f'{position:g}': RunSettings(
            KnownSettings(replace(THESIS_SCENARIO, pedal_position=position))
        )
        for position in (0.0, 0.25, 0.5, 0.75, 1.0)
    }
    return run_study(
        'pedal_mpc in the thesis scenario, by the position of the pedal',
        ('pedal_position', 't_f s'),
        (*TABLE_5_1, _SETTLED),
        [
            (
                (position, f'{engagement_time_s(ControllerContext(settings.known, {})):.2f}'),
                study_run(settings, 'pedal_mpc'),
            )
            for position, settings in every.items()
        ],
        (_SETTLED_REMARK,),
    )


def engine_authority() -> Study:
    """Run the controllers of both inputs between full authority over the engine and none."""
    cases = [(name, case) for name in ('mpc4', 'mpc4_wear') for case in AUTHORITIES]
    cases += [(name, 'none') for name in ('mpc3', 'mpc_preview')]
    settings = {
        case: RunSettings(KnownSettings(replace(THESIS_SCENARIO, engine_authority=authority)))
        for case, authority in {**AUTHORITIES, 'none': EngineAuthority()}.items()
    }
    return run_study(
        'Two inputs in the thesis scenario, by what the engine may do about the demand',
        ('controller', 'authority'),
        (
            *TWO_INPUTS,
            metric_column(METRICS['peak_jerk_m_s3'], '.1f', weight=Weight.USEFUL),
            TextColumn('friction kJ', '.2f', friction_kj, weight=Weight.USEFUL),
        ),
        [((name, case), study_run(settings[case], name)) for name, case in cases],
    )


def two_input_wear() -> Study:
    """Run the controllers of both inputs worn: the rows of MPC4 in Table 5.2 in numbers."""
    return run_study(
        'Two inputs in the thesis scenario, by wear of the clutch',
        ('controller', 'K_usura'),
        TWO_INPUTS,
        [
            ((name, f'{gain:g}'), thesis_run(name, 'detailed', gain))
            for name, gains in TWO_INPUT_GAINS.items()
            for gain in gains
        ],
    )
