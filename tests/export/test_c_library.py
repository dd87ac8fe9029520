# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers written in C run from a file like any other; their errors have one line."""

import functools
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from refusals import refused
from support.exported_mpc import STRICT, compile_c, run_settings

from ddct_bringup.programs.bringup import main as bringup
from ddct_bringup.run.headless import run_headless
from ddct_controllers.check.checks import FAIL, check_controller
from ddct_controllers.from_file.c_library import library as c_library
from ddct_controllers.interface import Command, Controller
from ddct_controllers.mpc.export.export_controller import export_controller
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.program import own_process
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

TOLERANCE_N_M = 1e-6
"""Tolerance in N m, as between the C and Python of a controller: both solvers leave about 1e-9."""
SETTINGS = run_settings('duration_s=1')
TEMPLATE = (c_library.TEMPLATE / 'my_controller.c').read_text()


@pytest.fixture(scope='module')
def compiled(tmp_path_factory):
    """Return a function that compiles C, the same C once, and returns the library's path."""

    @functools.cache
    def make(source: str) -> Path:
        folder = tmp_path_factory.mktemp('library')
        (folder / c_library.HEADER).write_bytes(
            (c_library.TEMPLATE / c_library.HEADER).read_bytes()
        )
        (folder / 'my_controller.c').write_text(source)
        unfinished = () if source == TEMPLATE else ('-w',)
        flags = ('-shared', '-fPIC', *unfinished)
        compile_c(folder, *flags, 'my_controller.c', '-o', 'my_controller.so')
        return folder / 'my_controller.so'

    return make


@pytest.fixture
def library(tmp_path, compiled):
    """Return a function that writes the file of a controller in C, and returns its path."""

    def make(source: str, parameters: str = '{}') -> str:
        file = tmp_path / 'my_controller.yaml'
        keys = f'{{file: {compiled(source)}, parameters: {parameters}}}'
        file.write_text(f'name: my_controller\nc_library: {keys}\n')
        return str(file)

    return make


@pytest.fixture
def exported(tmp_path):
    """Return a function that exports and compiles a controller, and returns its YAML file."""

    def make(name: str, settings: RunSettings = SETTINGS) -> str:
        folder = tmp_path / name
        export_controller(make_controller(name, settings.known), name, settings.known, folder)
        sources = ('ddct_mpc.c', 'ddct_mpc_library.c')
        compile_c(folder, '-O0', '-shared', '-fPIC', *sources, '-o', 'ddct_mpc.so')
        file = folder / 'mpc.yaml'
        file.write_text(f'name: {name}_in_c\nc_library: {{file: ddct_mpc.so}}\n')
        return str(file)

    return make


def command(source: str) -> str:
    """Return the template with `source` as the body of update."""
    head, _, _ = TEMPLATE.partition('    const double slip =')
    return f'{head}    {source} return 0;\n}}\n'


@pytest.mark.parametrize('name', ['mpc4', 'mpc_preview'])
def test_the_exported_mpc_run_from_its_file_gives_the_torques_of_python(exported, name):
    expected = run_headless(SETTINGS, name)
    found = run_headless(SETTINGS, exported(name))
    assert np.abs(found.torque_request - expected.torque_request).max() <= TOLERANCE_N_M
    assert np.abs(found.engine_torque - expected.engine_torque).max() <= TOLERANCE_N_M
    assert np.ptp(expected.torque_request[60:]) > 1.0, 'this run asks nothing of the controller'


def test_in_a_shift_the_exported_mpc_starts_as_that_of_python_does(exported):
    scenario = load_scenario('upshift', ['duration_s=1.6'])
    shift = RunSettings(KnownSettings(scenario))
    expected = run_headless(shift, 'mpc_offset_free')
    found = run_headless(shift, exported('mpc_offset_free', shift))
    assert np.abs(found.torque_request - expected.torque_request).max() <= TOLERANCE_N_M
    assert expected.closed_loop_torque.max() > 10.0, 'this run asks nothing of the controller'


def test_the_template_is_a_pi_controller(library):
    gains = {'proportional_gain': 0.1, 'integral_gain': 0.1}
    expected = run_headless(SETTINGS, make_controller('pi', SETTINGS.known, gains))
    found = run_headless(SETTINGS, library(TEMPLATE))
    assert np.abs(found.torque_request - expected.torque_request).max() <= 1e-9


def test_a_file_gives_global_variables_of_c_other_values(library):
    gains = {'proportional_gain': 0.31, 'integral_gain': 0.07}
    file = library(TEMPLATE, str(gains))
    ours = run_headless(SETTINGS, make_controller(file, SETTINGS.known))
    assert _torques_differ_by(ours, make_controller('pi', SETTINGS.known, gains)) <= TOLERANCE_N_M
    changed = run_settings('duration_s=1', 'controllers.my_controller.integral_gain=0.5')
    again = run_headless(changed, make_controller(file, changed.known))
    other = make_controller('pi', SETTINGS.known, {**gains, 'integral_gain': 0.5})
    assert _torques_differ_by(again, other) <= TOLERANCE_N_M


def _torques_differ_by(run, controller):
    theirs = run_headless(SETTINGS, controller)
    return np.abs(run.torque_request - theirs.torque_request).max()


@pytest.mark.parametrize('name', ['missing', 'two words', 'double'])
def test_a_variable_that_c_does_not_have_is_named(library, name):
    file = library(TEMPLATE, f'{{"{name}": 1.0}}')
    with refused(
        ParameterError, key=f'c_library.parameters.{name}', place='my_controller.yaml: line 2'
    ):
        make_controller(file, SETTINGS.known)


def test_two_controllers_of_one_library_share_no_state(library):
    file = library(TEMPLATE)
    first, second = (make_controller(file, SETTINGS.known) for _ in range(2))
    expected = run_headless(SETTINGS, second)
    first.reset()
    both = run_headless(SETTINGS, Interleaved(second, first))
    assert both.sha256() == expected.sha256()


class Interleaved(Controller):
    """One controller, each of its calls preceded by the same call of another."""

    def __init__(self, controller: Controller, other: Controller) -> None:
        self._controller, self._other = controller, other

    def reset(self) -> None:
        self._controller.reset()

    def update(self, measurement):
        self._other.update(measurement)
        return self._controller.update(measurement)


@pytest.mark.parametrize(
    ('source', 'check'),
    [
        ('command->clutch_torque = 0.0 / 0.0;', 'answers'),
        ('command->clutch_torque = -0.1 * m->engine_speed;', 'sign'),
    ],
)
def test_an_error_of_a_controller_in_c_is_placed_in_its_file_and_function(library, source, check):
    file = library(command(source))
    found = {
        each.name: each.detail
        for each in check_controller(file, SETTINGS.known)
        if each.state == FAIL
    }
    assert f'ddct_controller_update of {file} line ' in found[check]
    assert found[check].partition(' line ')[2].partition(')')[0].endswith('(c_library')
    assert not [detail for detail in found.values() if '.py' in detail]


def test_output_and_status_of_c_are_kept_apart_from_its_torques(library, capfd):
    source = command('command->clutch_torque = -1.0; puts("hello"); return 7;')
    run = run_headless(SETTINGS, library(f'#include <stdio.h>\n{source}'))
    assert dict(run.status[-1])['c_status'] == '7'
    assert run.closed_loop_torque[-1] == -1.0
    printed = capfd.readouterr()
    assert 'hello' in printed.err
    assert printed.out == ''


def test_preview_and_engine_command_are_as_the_library_declares(library):
    source = command(
        'command->clutch_torque = m->slip_reference[20] + m->slip_reference_rate[20];'
        'command->engine_torque = m->engine_torque + 0.001 * (double)m->step;'
    ).replace('(my_state, 0, 0)', '(my_state, 20, 1)')
    in_c = make_controller(library(source), SETTINGS.known)
    expected = run_headless(SETTINGS, InPython())
    found = run_headless(SETTINGS, in_c)
    assert found.torque_request.tobytes() == expected.torque_request.tobytes()
    assert found.engine_torque.tobytes() == expected.engine_torque.tobytes()


class InPython(Controller):
    """The controller in Python that the C of the test above is."""

    preview_steps = 20
    commands_engine = True

    def reset(self) -> None:
        pass

    def update(self, m):
        own = m.slip_reference[20] + m.slip_reference_rate[20]
        return Command(own, (), m.engine_torque + 0.001 * m.step)


@pytest.mark.parametrize(
    ('source', 'complaint'),
    [
        ('int nothing;\n', 'it has no ddct_controller: include ddct_controller.h'),
        (
            TEMPLATE.replace('ddct_controller_update', 'update'),
            'it has no ddct_controller_update: ',
        ),
        (
            TEMPLATE.replace('DDCT_DESCRIPTION(my_state, 0, 0)', '{2, 80, 16, 8, 0, 0}'),
            'its interface_version is 2, this version has 1: compile it with',
        ),
        (
            TEMPLATE.replace('DDCT_DESCRIPTION(my_state, 0, 0)', '{1, 96, 16, 8, 0, 0}'),
            'its measurement_bytes is 96, this version has 80',
        ),
        (TEMPLATE.replace('(my_state, 0, 0)', '(my_state, -1, 0)'), 'its preview_steps is -1'),
        (TEMPLATE.replace('(my_state, 0, 0)', '(my_state, 0, 7)'), 'its commands_engine 7'),
    ],
)
def test_a_library_of_another_interface_is_refused(compiled, source, complaint):
    with pytest.raises(c_library.LibraryError, match=re.escape(complaint)):
        c_library.Library(compiled(source))


def test_the_refusal_of_a_library_is_one_line_with_its_place(library):
    file = library('int nothing;\n')
    with pytest.raises(DdctError) as caught:
        make_controller(file, SETTINGS.known)
    assert str(caught.value).startswith(f'controller file {file}: line 2: c_library.file: ')
    assert 'it has no ddct_controller: include' in str(caught.value)
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize(
    ('body', 'complaint'),
    [
        ('return -3;', 'it returned -3 when update was called at step 60'),
        ('command->clutch_torque = 0.0 / (m->step * 0.0);', 'its torque at step 60 is '),
    ],
)
def test_a_failure_in_c_ends_the_run(library, body, complaint):
    with pytest.raises(DdctError, match=re.escape(complaint)):
        run_headless(SETTINGS, library(command(body)))


def test_a_crash_in_c_is_one_line_of_the_program(library, tmp_path, capsys):
    file = library(command('volatile double *p = 0; *p = 1.0;'))
    out = str(tmp_path / 'runs')
    assert bringup(['--controller', file, '--headless', '--out', out]) == 1
    (line,) = [each for each in capsys.readouterr().err.splitlines() if 'controller' in each]
    assert 'it crashed (SIGSEGV) when update was called at' in line


@pytest.mark.parametrize(
    'source',
    [TEMPLATE.replace('s->integral_rpm_s = 0.0;', '(void)s;'), command('')],
    ids=['state that reset leaves', 'torque that update leaves'],
)
def test_outputs_that_c_does_not_write_are_nan(library, source):
    with refused(DdctError, "controller 'my_controller': its torque at step 60"):
        run_headless(SETTINGS, library(source))


def test_a_loop_without_end_is_ended(library, monkeypatch):
    monkeypatch.setattr(own_process, '_MOST_SECONDS', 0.5)
    file = library(command('for (;;) {}'))
    with refused(DdctError, 'c_library.file', place=f'{file}: line 2') as raised:
        run_headless(SETTINGS, file)
    assert 'it gave no answer within 0.5 s when update was called at step 60' in str(raised.value)


@pytest.mark.parametrize(
    ('content', 'complaint'),
    [
        (
            '{file: none.so}',
            'none.so cannot be read (No such file or directory): give a shared library, compiled',
        ),
        ('{file: mine.yaml}', 'it cannot be loaded'),
        ('{file: 3}', 'c_library.file is 3: give the path of a shared library'),
        ('{path: a.so}', 'c_library: key file is missing'),
        ('{file: a.so, gain: 2}', "unknown key 'c_library.gain'"),
    ],
)
def test_a_file_without_a_library_is_refused(tmp_path, content, complaint):
    file = tmp_path / 'mine.yaml'
    file.write_text(f'name: mine\nc_library: {content}\n')
    with pytest.raises(DdctError) as caught:
        make_controller(str(file), SETTINGS.known)
    assert str(caught.value).startswith(f'controller file {file}: line 2: ')
    assert complaint in str(caught.value)
    assert '\n' not in str(caught.value)


def test_a_library_that_was_compiled_again_is_loaded_again(library):
    file = library(TEMPLATE)
    first = run_headless(SETTINGS, file).torque_request.tolist()
    again = run_headless(SETTINGS, library(command('command->clutch_torque = 7.0;')))
    assert again.torque_request.tolist() != first


def test_reset_is_called_before_hold_and_update(library):
    """With a state that begins at 7: run without a call of reset it would begin at 0."""
    source = TEMPLATE.replace('s->integral_rpm_s = 0.0;', 's->integral_rpm_s = 7.0;')
    source = source.partition('    const double slip =')[0]
    source += '    command->clutch_torque = ((my_state *)state)->integral_rpm_s; return 0;\n}\n'
    source += 'int32_t ddct_controller_hold(void *state, const ddct_measurement *m)\n'
    source += '{\n    (void)state; (void)m; return 0;\n}\n'
    assert source != TEMPLATE
    assert run_headless(SETTINGS, library(source)).closed_loop_torque[-1] == 7.0


def test_the_header_is_c_as_strict_as_the_export(tmp_path):
    (tmp_path / 'one.c').write_text(f'#include "{c_library.HEADER}"\n')
    command = ['cc', *STRICT, '-I', str(c_library.TEMPLATE), '-fsyntax-only', 'one.c']
    subprocess.run(command, cwd=tmp_path, check=True)
