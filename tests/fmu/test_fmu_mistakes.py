# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An error of an FMU, or of its mapping, is one line with file and key."""

import re
import sys
import zipfile
from pathlib import Path

import pytest
from support.fmu import EVENTS, GAINS, controller_file, faulty, write_fmu

from ddct_bringup.run.headless import run_headless
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.usefixtures('folder')
SETTINGS = RunSettings(KnownSettings(load_scenario('thesis', ['duration_s=1', GAINS])))
UNREADABLE = 'controller file mine.yaml: line 3: fmu.file: '


def complaint(file: str) -> str:
    """Return the one line of the error for a controller that cannot be made."""
    with pytest.raises(DdctError) as raised:
        make_controller(file, SETTINGS.known)
    text = str(raised.value)
    assert '\n' not in text
    assert text.startswith('controller file mine.yaml: ')
    return text


@pytest.mark.parametrize(
    ('old', 'new', 'words'),
    [
        ('file: pi.fmu', 'file: other.fmu', 'line 3: fmu.file: other.fmu cannot be read'),
        ('file: pi.fmu', 'file: mine.yaml', 'line 3: fmu.file: mine.yaml is no FMU'),
        ('file: pi.fmu', 'file: 3', 'line 3: fmu.file is 3: give the path'),
        ('file: pi.fmu', 'path: pi.fmu', 'fmu: key file is missing'),
        ('{e: slip', '{ee: slip', 'line 4: fmu.inputs.ee: .* no variable .* did you mean e?'),
        ('{e: slip', '{u: slip', 'line 4: fmu.inputs.u: it is output of type'),
        ('slip_error_rpm', 'slip_error', "line 4: fmu.inputs.e is 'slip_error': did you mean"),
        ('slip_error_rpm', 'engine_speed_rad_s', 'line 4: .* the FMU has it in rev/min'),
        ('slip_error_rpm', "'slip_error_rpm[2]'", 'line 4: fmu.inputs.e is .*: known: slip_ref'),
        ('{e: slip_error_rpm}', '3', 'fmu.inputs: give keys and values'),
        ('{e: slip_error_rpm}', '{}', 'fmu.inputs: input e of pi.fmu is not among them: map it'),
        ('{u: clutch', '{pid.Kp: clutch', 'line 5: fmu.outputs.pid.Kp: it is parameter'),
        ('clutch_torque_n_m', 'torque', "fmu.outputs.u is 'torque': give clutch_torque_n_m"),
        ('{u: clutch_torque_n_m', '{engine: engine_torque_n_m', 'none is clutch_torque_n_m'),
        ('n_m}', 'n_m, engine: clutch_torque_n_m}', 'fmu.outputs.engine is .* each once'),
        ('pid.Kp: 0.2', 'pid.Kp: much', "line 6: fmu.parameters.pid.Kp is 'much': give a number"),
        ('pid.Kp: 0.2', 'pid.Kp: -1', 'line 6: .*Kp is -1: it must be at least 0'),
        ('pid.Kp: 0.2', 'fault: 1.5', 'line 6: fmu.parameters.fault is 1.5: give a whole number'),
        ('pid.Kp: 0.2', 'inverted: 1', 'fmu.parameters.inverted is 1: give true or false'),
        ('pid.Kp: 0.2', 'pid.Kq: 1', 'line 6: fmu.parameters.pid.Kq: .* did you mean pid.K'),
        ('pid.Kp: 0.2', 'gain: 1', 'fmu.parameters.gain: .* known: pid.Kp, pid.Ki, fault'),
        ('pid.Kp: 0.2', 'u: 1', 'fmu.parameters.u: output of type .* takes no start value'),
        ('parameters', 'parameter', 'line 6: .*did you mean parameters?'),
    ],
)
def test_a_mistake_in_the_controller_file_is_named(old: str, new: str, words: str) -> None:
    assert re.search(words, complaint(controller_file(2, (old, new))))


def test_an_fmu_that_cannot_run_here_is_refused() -> None:
    version = 3
    file = controller_file(version)
    fmu = Path('pi.fmu')
    write_fmu(fmu, version, platform='win64')
    assert 'has no binary for ' in complaint(file)
    assert 'but for win64: export it for this platform' in complaint(file)
    write_fmu(fmu, version, interface='ModelExchange')
    assert 'pi.fmu is not for co-simulation by FMI 2.0 or 3.0' in complaint(file)
    write_fmu(fmu, version, ('stepSize="0.01"', 'stepSize="0.02"'))
    assert 'pi.fmu has a fixed step of 0.02 s: export it with 0.01 s' in complaint(file)
    write_fmu(fmu, version, ('stepSize="0.01"', 'stepSize="0.004"'))
    assert 'has a fixed step of 0.004 s' in complaint(file)
    write_fmu(fmu, version, ('{pi}', '{another}'))
    assert 'pi.fmu failed when it is loaded (Failed to instantiate' in complaint(file)
    write_fmu(fmu, version, ('</ModelVariables>', ''))
    assert complaint(file).startswith(f'{UNREADABLE}pi.fmu is no FMU (')
    for step in ('0.005', '0.01'):
        write_fmu(fmu, version, ('stepSize="0.01"', f'stepSize="{step}"'))
        make_controller(file, SETTINGS.known)


def test_other_versions_and_broken_binaries_are_refused() -> None:
    file = controller_file(2)
    with zipfile.ZipFile('pi.fmu', 'w') as fmu:
        fmu.writestr('resources/read.me', 'nothing')
    assert 'pi.fmu is no FMU (' in complaint(file)
    write_fmu(Path('pi.fmu'), 2)
    with zipfile.ZipFile('pi.fmu') as whole:
        text = whole.read('modelDescription.xml')
    with zipfile.ZipFile('pi.fmu', 'w') as fmu:
        fmu.writestr('modelDescription.xml', text)
        fmu.writestr('binaries/linux64/pi.so', b'no library')
    here = Path.cwd()
    assert 'pi.fmu failed when it is loaded (Failed to load' in complaint(file)
    assert Path.cwd() == here
    assert list(Path('tmp').iterdir()) == []


@pytest.mark.parametrize(
    ('version', 'fault', 'words'),
    [
        (2, 1, r'pi.fmu failed at its own time 0.1 s \(.*DoStep failed with status 3 \(error\)'),
        (3, 2, r'pi.fmu failed at its own time 0.1 s \(.*DoStep failed with status 4 \(fatal\)'),
        (2, 3, 'fmu.outputs.u at step 70 is nan: mend'),
        (3, 4, 'pi.fmu failed at its own time 0.1 s'),
    ],
)
def test_an_fmu_that_fails_in_a_run_ends_it(version: int, fault: int, words: str) -> None:
    faulty = f'fault: {fault}, fault_time: 0.1, remark: out of oil, pid.Kp'
    file = controller_file(version, ('pid.Kp', faulty))
    with pytest.raises(DdctError) as raised:
        run_headless(SETTINGS, file)
    assert re.search(words, str(raised.value))
    assert str(raised.value).startswith('controller file mine.yaml: line ')
    assert ('out of oil after 10 steps' in str(raised.value)) == (fault in (1, 2))
    del raised  # the error refers to the controller, which has processes


@pytest.mark.parametrize('version', [2, 3])
def test_a_message_of_an_earlier_step_is_not_the_reason_of_a_failure(version: int) -> None:
    faulty = 'fault: 9, fault_time: 0.1, remark: out of oil, pid.Kp'
    with pytest.raises(DdctError) as raised:
        run_headless(SETTINGS, controller_file(version, ('pid.Kp', faulty)))
    assert re.search(r'pi.fmu failed at its own time 0.11 s \(.*status 3', str(raised.value))
    assert 'out of oil' not in str(raised.value)


def test_an_fmu_that_cannot_be_unpacked_is_refused_and_leaves_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    import fmpy

    def full(*_: object) -> None:
        raise OSError('No space left on device')

    monkeypatch.setattr(fmpy, 'extract', full)
    text = complaint(controller_file(2))
    assert 'pi.fmu failed when it is loaded (No space left on device): mend' in text
    assert list(Path('tmp').iterdir()) == []


@pytest.mark.parametrize(
    ('fault', 'events'), [(1, ['instantiated', 'freed']), (2, ['instantiated'])]
)
def test_after_a_fatal_failure_alone_an_fmu_is_not_freed(
    fault: int, events: list[str], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(EVENTS, str(folder / 'events'))
    with pytest.raises(DdctError):
        run_headless(SETTINGS, faulty(2, fault))
    assert (folder / 'events').read_text().split() == events
    assert list(Path('tmp').iterdir()) == []


def test_the_error_without_fmpy_names_the_command_that_installs_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, 'fmpy', None)
    assert 'FMPy is not installed: `make setup EXTRAS=fmu`' in complaint(controller_file(2))
