# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""FMUs that are too large, or whose description no machine can use, are refused at once."""

from pathlib import Path

import pytest
from refusals import refused
from support.fmu import GAINS, VERSIONS, controller_file, write_fmu

from ddct_controllers.from_file.fmu import file_limits
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

pytestmark = pytest.mark.usefixtures('folder')
SETTINGS = RunSettings(load_scenario('thesis', ['duration_s=1', GAINS]))


def refused_file(version: int, *changes: tuple[str, str], **options) -> str:
    """Require that the FMU, so changed, is refused before it is unpacked; return the text."""
    file = controller_file(version)
    write_fmu(Path('pi.fmu'), version, *changes, **options)
    with refused(ParameterError, 'fmu.file', place='mine.yaml: line 3') as raised:
        make_controller(file, SETTINGS)
    assert list(Path('tmp').iterdir()) == []
    return str(raised.value)


@pytest.mark.parametrize('version', VERSIONS)
@pytest.mark.parametrize('step', ['nan', 'inf', '0', '-0.01', '1e-320', 'often', '1e400'])
def test_a_step_that_no_clock_can_take_is_refused(version: int, step: str) -> None:
    text = refused_file(version, ('stepSize="0.01"', f'stepSize="{step}"'))
    assert f'has a fixed step of {step} s' in text


@pytest.mark.parametrize('version', VERSIONS)
def test_an_fmu_that_unpacks_to_too_much_is_refused(
    version: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(file_limits, 'MOST_UNPACKED_BYTES', 1 << 21)
    assert 'unpacks to' in refused_file(version, more={'resources/zeros': bytes(1 << 21)})
    assert Path('pi.fmu').stat().st_size < 1 << 16
    monkeypatch.setattr(file_limits, 'MOST_FILES', 3)
    assert 'unpacks to 4 files' in refused_file(version, more={'resources/more': b''})


@pytest.mark.parametrize('version', VERSIONS)
def test_a_description_that_is_too_long_is_refused(
    version: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    many = file_limits.MOST_ELEMENTS * '<Unit/>'
    assert 'elements' in refused_file(version, ('</UnitDefinitions>', f'{many}</UnitDefinitions>'))
    monkeypatch.setattr(file_limits, 'MOST_DESCRIPTION_BYTES', 1000)
    assert 'bytes' in refused_file(version)


@pytest.mark.parametrize('version', VERSIONS)
def test_a_description_takes_no_text_of_another_file(version: int) -> None:
    Path('secret').write_text('secret')
    entity = f'<!DOCTYPE x [<!ENTITY file SYSTEM "{Path("secret").absolute().as_uri()}">]>'
    changes = (
        ('<fmiModelDescription', f'{entity}\n<fmiModelDescription'),
        ('<Unit name="s"/>', '<Unit name="s"/>&file;'),
    )
    assert 'document type' in refused_file(version, *changes)


@pytest.mark.parametrize('version', VERSIONS)
def test_its_binary_is_no_file_outside_of_it(version: int) -> None:
    """The identifier is a part of a path, and a name in the ZIP file may be any text."""
    text = refused_file(version, ('modelIdentifier="pi"', 'modelIdentifier="../../../pi"'))
    assert "its modelIdentifier is '../../../pi'" in text
    text = refused_file(version, (' modelIdentifier="pi"', ''))
    assert "its modelIdentifier is ''" in text


@pytest.mark.parametrize('version', VERSIONS)
def test_files_that_name_a_place_outside_stay_in_its_folder(version: int, folder: Path) -> None:
    file = controller_file(version)
    write_fmu(Path('pi.fmu'), version, more={'../outside': b'x', 'resources/../../beside': b'x'})
    made = make_controller(file, SETTINGS)
    (unpacked,) = (folder / 'tmp').iterdir()
    found = [each for each in folder.rglob('*') if each.name in ('outside', 'beside')]
    assert sorted(each.name for each in found) == ['beside', 'outside']
    assert all(each.is_relative_to(unpacked) for each in found)
    del made


@pytest.mark.parametrize('end', ['min', 'max'])
def test_a_range_that_is_no_number_is_refused(end: str) -> None:
    file = controller_file(2)
    write_fmu(Path('pi.fmu'), 2, ('min="0" start="0.1"', f'{end}="much" start="0.1"'))
    with refused(ParameterError, 'fmu.parameters.pid.Kp', place='mine.yaml: line 6'):
        make_controller(file, SETTINGS)
