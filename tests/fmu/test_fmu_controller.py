# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A PI controller in an FMU is the PI controller: to the bit, in every way to run it."""

import gc
import hashlib
from pathlib import Path

import numpy as np
import pytest
from support.fmu import EVENTS, GAINS, VERSIONS, controller_file, write_fmu

from ddct_bringup.run.headless import run_headless
from ddct_controllers.registry import controller_label, controller_spec, make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.usefixtures('folder')


def settings(*changes: str) -> RunSettings:
    return RunSettings(KnownSettings(load_scenario('thesis', ['duration_s=1', GAINS, *changes])))


@pytest.mark.parametrize('version', VERSIONS)
def test_an_fmu_gives_the_torques_of_the_pi_to_the_bit(version: int) -> None:
    found = run_headless(settings(), controller_file(version))
    pi = run_headless(settings(), 'pi')
    assert np.ptp(pi.torque_request[60:]) > 1.0, 'this run asks nothing of the controller'
    assert np.array_equal(found.torque_request, pi.torque_request)


@pytest.mark.parametrize('version', VERSIONS)
def test_the_tests_fmu_is_one_by_the_standard(version: int) -> None:
    import fmpy

    fmu = write_fmu(Path('pi.fmu'), version)
    assert fmpy.read_model_description(fmu, validate=True).fmiVersion == f'{version}.0'


def test_a_second_run_begins_anew() -> None:
    version = 2
    controller = make_controller(controller_file(version), settings().known)
    first, second = (run_headless(settings(), controller) for _ in range(2))
    assert first.sha256() == second.sha256()


def test_two_controllers_of_one_file_share_no_state() -> None:
    file = controller_file(2)
    alone = run_headless(settings(), file)
    one, other = (make_controller(file, settings().known) for _ in range(2))
    run_headless(settings('duration_s=0.8'), other)
    assert run_headless(settings(), one).sha256() == alone.sha256()


@pytest.mark.parametrize('version', VERSIONS)
def test_every_instance_is_freed_and_no_file_stays(
    version: int, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(EVENTS, str(folder / 'events'))
    controller = make_controller(controller_file(version), settings().known)
    assert len([each for each in (folder / 'tmp').iterdir() if each.is_dir()]) == 1
    for _ in range(2):
        run_headless(settings(), controller)
    del controller
    gc.collect()
    assert list((folder / 'tmp').iterdir()) == []
    assert (folder / 'events').read_text().split() == 2 * ['instantiated', 'freed']


def test_it_is_identified_by_the_digests_of_both_files() -> None:
    version = 3
    info = make_controller(controller_file(version), settings().known).info('mine')
    for key, file in (('controller_file_sha256', 'mine.yaml'), ('fmu_sha256', 'pi.fmu')):
        assert info[key] == hashlib.sha256(Path(file).read_bytes()).hexdigest()


def test_its_parameters_are_options() -> None:
    version = 3
    file = controller_file(version, ('pid.Ki: 0.3', 'pid.Ki: 0.9'))
    assert controller_label(file) == 'mine'
    found = run_headless(settings('controllers.mine.pid_Ki=0.3'), file)
    assert np.array_equal(found.torque_request, run_headless(settings(), 'pi').torque_request)
    assert controller_spec(file).options['pid_Ki'].default == 0.9
    for change, complaint in (
        ('pid_Kp=-1', 'controllers.mine.pid_Kp is -1: it must be at least 0'),
        ('Kp=1', 'controllers.mine.Kp is not a key of mine'),
    ):
        with pytest.raises(ParameterError, match=complaint):
            make_controller(file, settings(f'controllers.mine.{change}').known)


@pytest.mark.parametrize('version', VERSIONS)
def test_start_values_of_every_type_reach_the_fmu(version: int) -> None:
    typed = 'inverted: true, order: 2, fault: 0, remark: none, pid.Kp'
    found = run_headless(settings(), controller_file(version, ('pid.Kp', typed)))
    first, after = found.closed_loop_torque[60:62]
    assert first == 0.0
    error_rpm = (found.slip_reference[61, 0] - found.slip_speed[61]) * 30 / np.pi
    assert after == pytest.approx(0.2 * error_rpm + 0.3 * 0.01 * error_rpm, rel=1e-9)
    assert error_rpm != 0.0


def test_it_receives_the_reference_ahead_and_commands_the_engine() -> None:
    version = 2
    file = controller_file(
        version,
        ('{e: slip_error_rpm}', "{e: slip_error_rpm, ahead: 'slip_reference_rad_s[4]'}"),
        ('{u: clutch_torque_n_m}', '{u: clutch_torque_n_m, engine: engine_torque_n_m}'),
        ('demand: 0.0, ahead: 0.0', 'order: 1'),
        ('e: slip', 'demand: engine_torque_n_m, e: slip'),
    )
    found = run_headless(settings(), file)
    assert found.slip_reference.shape[1] == 5
    assert np.array_equal(found.engine_torque_request, found.torque_demand)
    assert np.ptp(found.engine_torque_request) > 1.0


def test_inputs_and_outputs_may_be_of_single_precision() -> None:
    file = controller_file(3)
    single = [(f'<Float64 name="{name}"', f'<Float32 name="{name}"') for name in 'eu']
    write_fmu(Path('pi.fmu'), 3, *single)
    found, pi = (run_headless(settings(), name).torque_request for name in (file, 'pi'))
    assert not np.array_equal(found, pi)
    assert np.allclose(found, pi, rtol=0.0, atol=1e-4)


def test_an_input_that_can_be_given_nothing_keeps_its_value() -> None:
    file = controller_file(3, (', ahead: 0.0', ''))
    write_fmu(Path('pi.fmu'), 3, ('<Float64 name="ahead"', '<Int8 name="ahead"'))
    found, pi = (run_headless(settings(), name).torque_request for name in (file, 'pi'))
    assert np.array_equal(found, pi)
