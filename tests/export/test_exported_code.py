# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The exported C itself: its calls, its response to bad input, and its example."""

import dataclasses
import math
import subprocess
from pathlib import Path

import pytest
from support.exported_mpc import (
    STRICT,
    ExportedController,
    compile_c,
    compiler,
    exported,
    run_settings,
)

from ddct_bringup.run.headless import run_headless
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError


class Recorded(Controller):
    """A controller that records its measurements and passes them on."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.preview_steps = controller.preview_steps
        self.commands_engine = controller.commands_engine
        self.measurements: list[tuple[bool, Measurement]] = []

    def reset(self) -> None:
        self._controller.reset()

    def hold(self, measurement: Measurement) -> None:
        self.measurements.append((False, measurement))
        self._controller.hold(measurement)

    def update(self, measurement: Measurement) -> Command:
        self.measurements.append((True, measurement))
        return self._controller.update(measurement)


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf, 1e10])
@pytest.mark.parametrize('field', ['engine_speed', 'load_torque', 'slip_reference'])
def test_a_bad_measurement_is_refused_and_leaves_no_trace(exported_mpc3, field, bad):
    """The calls before and after it return the same as without it."""
    measurements = [m for acts, m in exported_mpc3.measurements if acts][:20]
    value = [bad] * len(measurements[0].slip_reference) if field == 'slip_reference' else bad
    spoilt = dataclasses.replace(measurements[10], **{field: value})
    in_c = exported_mpc3.in_c
    in_c.reset()
    clean = [in_c.update(m).clutch_torque for m in measurements]
    in_c.reset()
    first = [in_c.update(m).clutch_torque for m in measurements[:10]]
    for call in (in_c.update, in_c.hold):
        with pytest.raises(DdctError):
            call(spoilt)
    rest = [in_c.update(m).clutch_torque for m in measurements[10:]]
    assert first + rest == clean


@dataclasses.dataclass(frozen=True)
class Exported:
    folder: Path
    in_c: ExportedController
    measurements: list[tuple[bool, Measurement]]


@pytest.fixture(scope='module')
def exported_mpc3(tmp_path_factory) -> Exported:
    """Return MPC3 with limits that bind, as C, and its measurements in a run."""
    settings = run_settings('controllers.mpc3.torque_rate_n_m_s=300')
    folder = tmp_path_factory.mktemp('mpc3') / 'c'
    recorded = Recorded(make_controller('mpc3', settings.known))
    run_headless(settings, recorded)
    in_c = exported(make_controller('mpc3', settings.known), 'mpc3', settings, folder)
    return Exported(folder, in_c, recorded.measurements)


def csv_lines(measurements: list[tuple[bool, Measurement]]) -> str:
    lines = []
    for acts, m in measurements:
        values = (
            *(m.engine_speed, m.shaft_speed, m.wheel_speed),
            *(m.engine_torque, m.load_torque, m.open_loop_torque),
            *(*m.slip_reference, *m.slip_reference_rate),
        )
        lines.append(','.join([str(int(acts)), *(repr(float(value)) for value in values)]))
    return '\n'.join(lines) + '\n'


@pytest.mark.parametrize('sanitizer', ['', 'address,undefined'])
def test_the_example_prints_the_same_torques(exported_mpc3, sanitizer):
    """Address and undefined-behaviour sanitizers find no error in a whole run."""
    folder, measurements = exported_mpc3.folder, exported_mpc3.measurements
    flags = ['-O1', '-g', f'-fsanitize={sanitizer}', '-fno-sanitize-recover=all']
    if sanitizer and not sanitizers_work(folder, flags):
        pytest.skip('cc has no sanitizers here')
    program = f'./example-{len(sanitizer)}'
    arguments = ('ddct_mpc.c', 'ddct_mpc_example.c', '-o', program)
    compile_c(folder, *(flags if sanitizer else []), *arguments)
    done = subprocess.run(
        [program], cwd=folder, input=csv_lines(measurements), capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, '')
    exported_mpc3.in_c.reset()
    lines = done.stdout.splitlines()
    for (acts, measurement), line in zip(measurements, lines, strict=True):
        if acts:
            expected = exported_mpc3.in_c.update(measurement).clutch_torque
            assert float(line.split(',')[0]) == pytest.approx(expected, abs=1e-9)
        else:
            exported_mpc3.in_c.hold(measurement)
            assert line == '0,0,0,0'


def sanitizers_work(folder: Path, flags: list[str]) -> bool:
    (folder / 'empty.c').write_text('int main(void) { return 0; }\n')
    command = [compiler(), *STRICT, *flags, 'empty.c', '-o', 'empty']
    built = subprocess.run(command, cwd=folder, capture_output=True)
    return built.returncode == 0 and subprocess.run([folder / 'empty']).returncode == 0


@pytest.fixture(scope='module')
def example(exported_mpc3) -> Path:
    """Return the compiled example."""
    compile_c(exported_mpc3.folder, 'ddct_mpc.c', 'ddct_mpc_example.c', '-o', 'example')
    return exported_mpc3.folder / 'example'


@pytest.mark.parametrize('line', ['1,2,3', '1,a,0'])
def test_the_example_names_a_line_that_it_cannot_read(exported_mpc3, example, line):
    text = csv_lines(exported_mpc3.measurements[:2]) + line + '\n'
    done = subprocess.run([example], input=text, capture_output=True, text=True)
    assert done.returncode == 1
    assert done.stderr == 'line 3 does not hold 9 numbers with commas between them\n'


@pytest.mark.parametrize('optimisation', ['-O0', '-O2'])
def test_nothing_is_called_and_nothing_can_be_written_but_the_callers_own(
    exported_mpc3, optimisation
):
    """No malloc, no libm; compilers make copies of arrays into calls of memcpy and the like."""
    folder = exported_mpc3.folder
    compile_c(folder, optimisation, '-fno-stack-protector', '-c', 'ddct_mpc.c')
    listed = subprocess.run(['nm', 'ddct_mpc.o'], cwd=folder, capture_output=True, text=True)
    symbols = [line.split()[-2:] for line in listed.stdout.splitlines()]
    assert {name for kind, name in symbols if kind == 'U'} <= {'memcpy', 'memmove', 'memset'}
    assert {name for kind, name in symbols if kind == 'T'} == {
        'ddct_mpc_hold',
        'ddct_mpc_reset',
        'ddct_mpc_update',
    }
    assert {kind for kind, _ in symbols} <= {'U', 'T', 't', 'r'}


def test_no_function_calls_itself_and_all_stack_frames_are_static(exported_mpc3):
    folder = exported_mpc3.folder
    compile_c(folder, '-O2', '-fstack-usage', '-Wvla', '-c', 'ddct_mpc.c')
    if not (folder / 'ddct_mpc.su').exists():
        pytest.skip('cc does not write stack usage')
    frames = [line.split() for line in (folder / 'ddct_mpc.su').read_text().splitlines()]
    assert frames
    assert {frame[-1] for frame in frames} == {'static'}
