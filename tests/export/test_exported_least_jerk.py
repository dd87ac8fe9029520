# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`least_jerk` as C: the same bits as in Python."""

from pathlib import Path

import numpy as np
import pytest
from refusals import refused
from support.exported_least_jerk import answers, in_c, random_measurement, settings_of

from ddct_bringup.run.headless import run_headless
from ddct_controllers.least_jerk.controller import NAME, SPEC
from ddct_controllers.least_jerk.export.export_least_jerk import export_least_jerk
from ddct_controllers.registry import make_controller
from ddct_controllers.workflows.design_program import main
from ddct_plant.base.errors import DdctError, ParameterError

LIMITED = {'deviation_n_m': 40.0, 'slew_n_m_s': 900.0, 'lag_s': 0.03, 'maximum_torque_n_m': 200.0}
"""Authority of an engine that each limit restricts."""


@pytest.fixture(scope='module')
def launch(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return the controller file of the C for a launch."""
    return in_c(settings_of('launch'), tmp_path_factory.mktemp('launch') / 'c')


def test_c_gives_the_bits_of_python_and_the_phases_of_the_lock(launch):
    """In a launch; every packaged scenario is tried in a nightly test."""
    settings = settings_of('launch')
    phases = ('slipping', 'confirming', 'closed')
    original, copy = (run_headless(settings, each) for each in (NAME, launch))
    assert copy.torque_request.tobytes() == original.torque_request.tobytes()
    assert np.ptp(original.closed_loop_torque) > 1.0, 'this run asks nothing of it'
    expected = [dict(row).get('phase') for row in original.status]
    found = [dict(row).get('c_status') for row in copy.status]
    start = settings.scenario.control_start_step
    named = [phases[int(status)] for status in found[start:] if status is not None]
    assert named == [phase for phase in expected[start:] if phase is not None]
    assert set(named) >= {'slipping', 'confirming'}


def test_a_worn_clutch_in_an_upshift_too(tmp_path):
    settings = settings_of('upshift', 0.7)
    original, copy = (run_headless(settings, each) for each in (NAME, in_c(settings, tmp_path)))
    assert copy.torque_request.tobytes() == original.torque_request.tobytes()
    assert np.ptp(original.closed_loop_torque) > 1.0, 'this run asks nothing of it'


def test_any_measurements_give_the_bits_of_python(launch):
    settings = settings_of('launch')
    original, copy = (make_controller(each, settings) for each in (SPEC, launch))
    for seed in range(5):
        assert answers(copy, seed) == answers(original, seed)


def test_the_shaped_demand_has_the_bits_of_python(tmp_path):
    settings = settings_of('tip_in', engine_authority=LIMITED)
    original, copy = (make_controller(each, settings) for each in (SPEC, in_c(settings, tmp_path)))
    for seed in range(5):
        found = answers(copy, seed)
        assert found == answers(original, seed)
        assert all(engine is not None for _, engine in found)


def test_a_measurement_that_is_no_number_ends_the_run_as_in_python(launch):
    copy = make_controller(launch, settings_of('launch'))
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
