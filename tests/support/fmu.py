# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
FMUs that the tests build: a PI controller in C, for FMI 2.0 and 3.0, with its description.

`python tests/support/fmu.py FILE.fmu` writes one of FMI 2.0, to try what an FMU does.
"""

import functools
import shutil
import subprocess
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / 'fmu' / 'pi_unit.c'
EVENTS = 'PI_UNIT_EVENTS'
"""Environment variable with the file into which the FMU writes when it is made and freed."""
LOAD_FAULT = 'PI_UNIT_LOAD_FAULT'
"""Environment variable with the number of a fault that the FMU has when it is instantiated."""
EXIT, ABORT, CRASH, LOOP = 5, 6, 7, 8
"""Numbers of the faults that end, or stop, the process of the FMU."""
VERSIONS = (2, 3)
PLATFORMS = {2: 'linux64', 3: 'x86_64-linux'}
CONTROLLER = """\
name: mine
fmu:
  file: pi.fmu
  inputs: {e: slip_error_rpm}
  outputs: {u: clutch_torque_n_m}
  parameters: {pid.Kp: 0.2, pid.Ki: 0.3, demand: 0.0, ahead: 0.0}
"""
GAINS = 'controllers.pi={proportional_gain: 0.2, integral_gain: 0.3}'
"""Change of a scenario that gives `pi` the gains of the FMU."""


def skip_without_fmus() -> None:
    """Skip a test on a machine that cannot build FMUs or run them."""
    pytest.importorskip('fmpy', reason='FMPy, an optional extra, is absent: EXTRAS=fmu')
    if shutil.which('cc') is None:
        pytest.skip('there is no C compiler cc')


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an empty folder, which is the present one; temporary files go into its `tmp`."""
    skip_without_fmus()
    monkeypatch.chdir(tmp_path)
    Path('tmp').mkdir()
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path / 'tmp'))
    monkeypatch.setenv('TMPDIR', str(tmp_path / 'tmp'))
    return tmp_path


@dataclass(frozen=True)
class _Variable:
    name: str
    reference: int
    types: tuple[str, str]
    """Type names in FMI 2.0 and 3.0."""
    causality: str
    start: str = ''
    unit: str = ''
    more: str = ''


_REAL, _INT, _ENUM = ('Real', 'Float64'), ('Integer', 'Int32'), ('Enumeration', 'Enumeration')
_VARIABLES = (
    _Variable('time', 40, _REAL, 'independent'),
    _Variable('e', 0, _REAL, 'input', '0', 'rev/min'),
    _Variable('demand', 1, _REAL, 'input', '0', 'N.m'),
    _Variable('ahead', 7, _REAL, 'input', '0'),
    _Variable('u', 2, _REAL, 'output', unit='N.m'),
    _Variable('engine', 3, _REAL, 'output', unit='N.m'),
    _Variable('pid.Kp', 4, _REAL, 'parameter', '0.1', more='min="0"'),
    _Variable('pid.Ki', 5, _REAL, 'parameter', '0.1'),
    _Variable('fault_time', 6, _REAL, 'parameter', '0', 's'),
    _Variable('fault', 20, _INT, 'parameter', '0', more='min="0" max="9"'),
    _Variable('order', 21, _ENUM, 'parameter', '1', more='declaredType="Order"'),
    _Variable('inverted', 30, ('Boolean', 'Boolean'), 'parameter', 'false'),
    _Variable('remark', 31, ('String', 'String'), 'parameter', 'nothing'),
)


def write_fmu(
    path: Path,
    version: int,
    *changes: tuple[str, str],
    platform: str = '',
    interface: str = '',
) -> Path:
    """
    Write the PI as an FMU, its description changed by (old, new) texts.

    `platform` is the name of the binary's folder where it differs from this machine's.
    """
    text = description(version, interface or 'CoSimulation')
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED) as file:
        file.writestr('modelDescription.xml', text)
        file.writestr('resources/read.me', 'nothing')
        file.writestr(f'binaries/{platform or PLATFORMS[version]}/pi.so', _binary(version))
    return path


@functools.cache
def _binary(version: int) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder, 'pi.so')
        subprocess.run(
            # No fused multiply-add: the torques must equal those of Python to the bit.
            ['cc', f'-DFMI={version}', '-O2', '-ffp-contract=off', '-Wall', '-Wextra', '-Werror']
            + ['-shared', '-fPIC', str(SOURCE), '-lm', '-o', str(output)],
            check=True,
        )
        return output.read_bytes()


def description(version: int, interface: str = 'CoSimulation') -> str:
    """Return the description of the FMU."""
    token = {2: 'guid', 3: 'instantiationToken'}[version]
    items = '<Item name="euler" value="1"/><Item name="trapezoidal" value="2"/>'
    order = {
        2: f'<SimpleType name="Order"><Enumeration>{items}</Enumeration></SimpleType>',
        3: f'<EnumerationType name="Order">{items}</EnumerationType>',
    }[version]
    outputs = [i for i, each in enumerate(_VARIABLES, 1) if each.causality == 'output']
    unknowns = ''.join(f'<Unknown index="{i}"/>' for i in outputs)
    structure = {
        2: f'<Outputs>{unknowns}</Outputs>',
        3: ''.join(f'<Output valueReference="{_VARIABLES[i - 1].reference}"/>' for i in outputs),
    }[version]
    units = ''.join(f'<Unit name="{unit}"/>' for unit in ('rev/min', 'N.m', 's'))
    variables = '\n'.join(_element(each, version) for each in _VARIABLES)
    return (
        f'<fmiModelDescription fmiVersion="{version}.0" modelName="pi" {token}="{{pi}}">\n'
        f'<{interface} modelIdentifier="pi"/>\n'
        f'<UnitDefinitions>{units}</UnitDefinitions>\n'
        f'<TypeDefinitions>{order}</TypeDefinitions>\n'
        '<DefaultExperiment stepSize="0.01"/>\n'
        f'<ModelVariables>{variables}</ModelVariables>\n'
        f'<ModelStructure>{structure}</ModelStructure>\n'
        '</fmiModelDescription>\n'
    )


def _element(each: _Variable, version: int) -> str:
    kind = each.types[version - 2]
    variability = 'fixed' if each.causality == 'parameter' else 'continuous'
    where = f'name="{each.name}" valueReference="{each.reference}" causality="{each.causality}"'
    unit = f' unit="{each.unit}"' if each.unit else ''
    more = f' {each.more}' if each.more else ''
    start = f' start="{each.start}"' if each.start else ''
    if version == 2:
        value = f'<{kind}{more}{unit}{start}/>'
        return f'<ScalarVariable {where} variability="{variability}">{value}</ScalarVariable>'
    if kind == 'String':
        value = f'<Start value="{each.start}"/>'
        return f'<String {where} variability="{variability}">{value}</String>'
    return f'<{kind} {where} variability="{variability}"{more}{unit}{start}/>'


def controller_file(version: int, *changes: tuple[str, str]) -> str:
    """Write `pi.fmu` and its controller file, changed by (old, new) texts; return the name."""
    write_fmu(Path('pi.fmu'), version)
    text = CONTROLLER
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    Path('mine.yaml').write_text(text, encoding='utf-8')
    return 'mine.yaml'


def faulty(version: int, fault: int) -> str:
    """Return the controller file of an FMU with a fault 0.1 s after its start."""
    return controller_file(version, ('pid.Kp', f'fault: {fault}, fault_time: 0.1, pid.Kp'))


def unpacked() -> set[str]:
    """Return the names of the temporary folders of FMUs; a lock file left counts as its folder."""
    return {each.name.removesuffix('.lock') for each in Path('tmp').glob('ddct_fmu*')}


if __name__ == '__main__':
    write_fmu(Path(sys.argv[1]), VERSIONS[0])
