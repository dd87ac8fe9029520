# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Values that a log contradicts are refused: ratio, times, units, signs; others are accepted."""

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from refusals import refused
from support.other_car import LASTS_S, TRUE, drive

from ddct_bringup.bag.measured_checks import require_no_contradiction
from ddct_bringup.programs import score
from ddct_bringup.run.headless import run_headless
from ddct_plant.base.errors import DdctError
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

RATIO = TRUE['total_ratio']
GEAR = EngagedGear(RATIO)
PER_RPM = np.pi / 30.0
Values = dict[str, np.ndarray]


@cache
def other_car() -> Values:
    of = drive(1)
    grid_s = 0.01 * np.arange(round(100 * LASTS_S))
    signals = {**of.signals, 'vehicle_accel': of.accel}
    values = {name: np.interp(grid_s, of.time_s, each) for name, each in signals.items()}
    return {**values, 'vehicle_speed': 0.32 * values['wheel_speed']}


def noisy(values: Values) -> Values:
    random = np.random.default_rng(2)
    sizes = {'engine_torque': 1.0, 'clutch_torque': 1.0, 'vehicle_accel': 0.05}
    return {
        name: each + sizes.get(name, 0.02) * random.standard_normal(len(each))
        for name, each in values.items()
    }


def times(name: str, factor: float) -> Callable[[Values], Values]:
    return lambda values: {**values, name: factor * values[name]}


def swapped(values: Values) -> Values:
    engine, clutch = values['engine_torque'], values['clutch_torque']
    return {**values, 'engine_torque': clutch, 'clutch_torque': engine}


CHANGED = {
    'wheels in rpm': (times('wheel_speed', 1 / PER_RPM), 'is 1.311, give or take'),
    'shaft in deg/s': (times('shaft_speed', 180 / np.pi), 'the factor is that of deg/s to rad/s'),
    'wheels turned round': (times('wheel_speed', -1.0), 'shaft_speed over wheel_speed is -12.5'),
    'V_x in km/h': (times('vehicle_speed', 3.6), 'vehicle_speed over wheel_speed gives wheels of'),
    'A_x in g': (times('vehicle_accel', 1 / 9.81), 'gives wheels of 0.03'),
    'A_x turned round': (times('vehicle_accel', -1.0), 'gives wheels of -0.3'),
    'engine in rpm': (times('engine_speed', 1 / PER_RPM), 'gives an engine of 0.018'),
    'C_m turned round': (times('engine_torque', -1.0), 'engine_torque has the wrong sign'),
    'C_f turned round': (times('clutch_torque', -1.0), 'clutch_torque has the wrong sign'),
    'C_f in kN m': (times('clutch_torque', 1e-3), 'clutch_torque over the acceleration of engine'),
    'torques swapped': (swapped, 'swap the two columns'),
}


@pytest.mark.parametrize(('change', 'complaint'), CHANGED.values(), ids=CHANGED)
@pytest.mark.parametrize('measured', [dict, noisy], ids=['exact', 'noisy'])
def test_a_unit_or_sign_that_the_log_contradicts_is_refused(
    change: Callable[[Values], Values],
    complaint: str,
    measured: Callable[[Values], Values],
) -> None:
    with pytest.raises(DdctError) as error:
        require_no_contradiction(GEAR, change(measured(other_car())))
    assert complaint in str(error.value)
    assert '\n' not in str(error.value)


@pytest.mark.parametrize('given', [RATIO * 1.03, RATIO / 1.03, 9.34])
def test_a_ratio_that_the_log_contradicts_is_refused_with_both_values(given: float) -> None:
    with pytest.raises(DdctError) as error:
        require_no_contradiction(EngagedGear(given), noisy(other_car()))
    assert str(error.value).startswith(f'run.total_ratio is {given:g}, but in the log')
    assert 'is 12.5' in str(error.value)


@pytest.mark.parametrize('measured', [dict, noisy], ids=['exact', 'noisy'])
def test_a_true_log_passes_with_any_of_its_columns_left_out(
    measured: Callable[[Values], Values],
) -> None:
    values = measured(other_car())
    require_no_contradiction(GEAR, values)
    require_no_contradiction(None, values)
    for left_out in values.keys() - {'engine_speed', 'shaft_speed', 'engine_torque'}:
        part = {name: each for name, each in values.items() if name != left_out}
        require_no_contradiction(GEAR, part)


@pytest.mark.parametrize(
    ('scenario', 'controller'), [('thesis', 'pi'), ('tip_in', 'ls8'), ('launch', 'pi')]
)
def test_what_the_bench_simulates_contradicts_nothing(scenario: str, controller: str) -> None:
    settings = RunSettings(KnownSettings(load_scenario(scenario)))
    run = run_headless(settings, controller)
    values = dict(zip(('engine_speed', 'shaft_speed', 'wheel_speed'), run.joint_speed.T))  # noqa: B905 the twist is left out
    values |= {'engine_torque': run.engine_torque, 'clutch_torque': run.joint_effort[:, 1]}
    values |= {'vehicle_speed': run.vehicle_speed, 'vehicle_accel': run.vehicle_accel}
    gear = settings.scenario.driveline.gear
    require_no_contradiction(gear, values)
    with refused(DdctError, 'run.total_ratio'):
        require_no_contradiction(EngagedGear(gear.shaft_speed(1.1)), values)
    del values['engine_torque']
    with refused(DdctError, 'clutch_torque'):
        require_no_contradiction(gear, times('clutch_torque', -1.0)(values))
    if controller == 'ls8':
        with refused(DdctError, 'engine_speed'):
            require_no_contradiction(None, times('engine_speed', PER_RPM)(values))


def test_a_car_that_hardly_moves_shows_no_ratio() -> None:
    values = {name: 0.001 * each for name, each in other_car().items() if 'speed' in name}
    require_no_contradiction(EngagedGear(9.34), values)


TIMES = {
    'control_start_s: 60.0': 'run.control_start_s is 60 s, but the log ends 5 s after',
    'control_start_s: 5.0': 'run.control_start_s is 5 s, but the log ends 5 s after',
    'score_window_s: [1.0, 6.0]': 'run.score_window_s is [1, 6] s, but the log has 0 s',
    'control_start_s: 2.0, score_window_s: [1.0, 2.0]': 'the log has 2 s (run.control_start_s)',
}


@pytest.mark.parametrize(('run', 'complaint'), TIMES.items())
def test_times_outside_the_log_are_refused(tmp_path: Path, run: str, complaint: str) -> None:
    rows = [f'{0.01 * k:.2f},{100.0 - 0.1 * k},50.0\n' for k in range(501)]
    (tmp_path / 'drive.csv').write_text('t,m,p\n' + ''.join(rows))
    (tmp_path / 'map.yaml').write_text(
        'columns:\n  time: {column: t, unit: s}\n  engine_speed: {column: m, unit: rad/s}\n'
        f'  shaft_speed: {{column: p, unit: rad/s}}\nrun: {{{run}}}\n'
    )
    out = tmp_path / 'scores.json'
    files = [str(tmp_path / 'drive.csv'), '--columns', str(tmp_path / 'map.yaml')]
    assert score.main([*files, '--json', str(out)]) == 1
    (entry,) = json.loads(out.read_text())['runs']
    assert entry['valid'] is False
    assert complaint in entry['reason']
