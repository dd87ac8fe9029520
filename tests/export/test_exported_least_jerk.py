# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`least_jerk` as C: the same bits as in Python, in every packaged scenario."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from refusals import refused
from support.exported_mpc import compile_c

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.run.headless import run_headless
from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.least_jerk.controller import NAME, SPEC
from ddct_controllers.least_jerk.export.export_least_jerk import export_least_jerk
from ddct_controllers.registry import make_controller
from ddct_controllers.workflows.design_program import main
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

COMPILE = ('-O2', '-ffp-contract=off', '-shared', '-fPIC', 'ddct_least_jerk.c', '-lm')
SCENARIOS = Cases.packaged().whole.values_of('scenario')


def settings_of(
    scenario: str, wear_gain: float = 1.0, clutch: str = 'stick_slip', **changes: Any
) -> RunSettings:
    """Return a run with the sensors of the benchmark, and sections of the scenario changed."""
    (sensors,) = Cases.packaged().content['grid']['sensors']
    changed = load_scenario(scenario, {'sensors': sensors, **changes}, clutch)
    return RunSettings(changed, clutch=clutch, wear_gain=wear_gain, seed=3)


def in_c(settings: RunSettings, folder: Path) -> str:
    """Return the controller file of the C that is exported for a run, and compiled."""
    export_least_jerk(make_controller(SPEC, settings), settings, folder)
    compile_c(folder, *COMPILE, '-o', 'ddct_least_jerk.so')
    return str(folder / 'least_jerk_in_c.yaml')


@pytest.mark.parametrize('scenario', SCENARIOS)
def test_c_gives_the_bits_of_python_in_every_packaged_scenario(tmp_path, scenario):
    for wear_gain in (0.7, 1.3):
        settings = settings_of(scenario, wear_gain)
        expected = run_headless(settings, NAME)
        found = run_headless(settings, in_c(settings, tmp_path / str(wear_gain)))
        assert found.torque_request.tobytes() == expected.torque_request.tobytes()
        assert np.ptp(expected.closed_loop_torque) > 1.0, 'this run asks nothing of it'


def test_the_linear_clutch_too(tmp_path):
    settings = settings_of('thesis', clutch='linear')
    expected = run_headless(settings, NAME)
    found = run_headless(settings, in_c(settings, tmp_path))
    assert found.torque_request.tobytes() == expected.torque_request.tobytes()


def test_the_status_in_c_is_the_phase_of_the_lock(tmp_path):
    settings = settings_of('launch')
    phases = ('slipping', 'confirming', 'closed')
    expected = [dict(row).get('phase') for row in run_headless(settings, NAME).status]
    found = [
        dict(row).get('c_status')
        for row in run_headless(settings, in_c(settings, tmp_path)).status
    ]
    start = settings.scenario.control_start_step
    named = [phases[int(status)] for status in found[start:] if status is not None]
    assert named == [phase for phase in expected[start:] if phase is not None]
    assert set(named) >= {'slipping', 'confirming'}


def random_measurement(random: np.random.Generator, step: int) -> Measurement:
    """Return a measurement that no loop gives: the plates part, lock and turn backward."""
    speed = random.uniform(-5.0, 700.0)
    return Measurement(
        step=step,
        engine_speed=speed,
        shaft_speed=speed - random.choice([0.1, 3.0, 60.0]) * random.standard_normal(),
        wheel_speed=random.uniform(-1.0, 60.0),
        vehicle_speed=3.0,
        engine_torque=random.uniform(-50.0, 300.0),
        slip_reference=[random.uniform(-20.0, 100.0)],
        slip_reference_rate=[random.uniform(-300.0, 50.0)],
        load_torque=random.uniform(-100.0, 400.0),
        open_loop_torque=random.uniform(-60.0, 300.0),
    )


def answers(controller: Controller, seed: int) -> list[tuple[float, float | None]]:
    """Return clutch and engine torques of an episode in N m; in some steps feedback is off."""
    random = np.random.default_rng(seed)
    controller.reset()
    torques = []
    for step in range(60):
        measurement = random_measurement(random, step)
        if random.random() < 0.1 or step < 5:
            controller.hold(measurement)
        else:
            command = controller.update(measurement)
            torques.append((command.clutch_torque, command.engine_torque))
    return torques


@pytest.mark.parametrize('scenario', ['launch', 'thesis', 'upshift'])
def test_any_measurements_give_the_bits_of_python(tmp_path, scenario):
    settings = settings_of(scenario)
    original = make_controller(SPEC, settings)
    copy = make_controller(in_c(settings, tmp_path), settings)
    for seed in range(20):
        assert answers(copy, seed) == answers(original, seed)


@pytest.mark.parametrize(
    'authority',
    [{}, {'deviation_n_m': 40.0, 'slew_n_m_s': 900.0, 'lag_s': 0.03, 'maximum_torque_n_m': 200.0}],
    ids=['full', 'limited'],
)
def test_the_shaped_demand_has_the_bits_of_python(tmp_path, authority):
    settings = settings_of('tip_in', engine_authority=authority)
    original = make_controller(SPEC, settings)
    copy = make_controller(in_c(settings, tmp_path), settings)
    for seed in range(10):
        found = answers(copy, seed)
        assert found == answers(original, seed)
        assert all(engine is not None for _, engine in found)


def test_a_measurement_that_is_no_number_ends_the_run_as_in_python(tmp_path):
    settings = settings_of('launch')
    copy = make_controller(in_c(settings, tmp_path), settings)
    bad = random_measurement(np.random.default_rng(1), 0).within(float('nan'), 0.0)
    with pytest.raises(DdctError):
        copy.update(bad)


def test_another_controller_is_refused(tmp_path):
    settings = settings_of('launch')
    with refused(ParameterError, NAME):
        export_least_jerk(make_controller('pi', settings), settings, tmp_path / 'c')
    assert not (tmp_path / 'c').exists()


def test_the_program_writes_what_it_prints_and_keeps_a_full_folder(tmp_path, capsys):
    export = ['least-jerk', '--export', str(tmp_path / 'c'), '--scenario', 'upshift']
    assert main(export) == 0
    printed = [Path(line) for line in capsys.readouterr().out.splitlines()]
    assert sorted(printed) == sorted((tmp_path / 'c').iterdir())
    assert 'scenario upshift, clutch stick_slip.' in printed[0].read_text()
    before = [file.read_bytes() for file in printed]
    assert main(export) == 1
    assert 'choose a new folder or add --overwrite' in capsys.readouterr().err
    assert main([*export, '--overwrite']) == 0
    assert [file.read_bytes() for file in printed] == before


@pytest.mark.parametrize(
    ('options', 'error'),
    [
        (['--set', 'controllers.least_jerk.jerk_m_s3=0'], 'jerk_m_s3 is 0'),
        (['--scenario', 'nowhere'], 'nowhere'),
    ],
)
def test_an_export_that_cannot_be_is_one_line_and_no_folder(tmp_path, capsys, options, error):
    assert main(['least-jerk', '--export', str(tmp_path / 'c'), *options]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert error in line
    assert not (tmp_path / 'c').exists()
