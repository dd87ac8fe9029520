# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""FMUs whose description no machine can use are refused before they are unpacked."""

from pathlib import Path

import pytest
from refusals import refused
from support.fmu import GAINS, VERSIONS, controller_file, write_fmu

from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.usefixtures('folder')
SETTINGS = RunSettings(KnownSettings(load_scenario('thesis', ['duration_s=1', GAINS])))


def refused_file(version: int, *changes: tuple[str, str]) -> str:
    """Require that the FMU, so changed, is refused before it is unpacked; return the text."""
    file = controller_file(version)
    write_fmu(Path('pi.fmu'), version, *changes)
    with refused(ParameterError, 'fmu.file', place='mine.yaml: line 3') as raised:
        make_controller(file, SETTINGS.known)
    assert list(Path('tmp').iterdir()) == []
    return str(raised.value)


@pytest.mark.parametrize('version', VERSIONS)
@pytest.mark.parametrize('step', ['nan', 'inf', '0', '-0.01', '1e-320', 'often', '1e400'])
def test_a_step_that_no_clock_can_take_is_refused(version: int, step: str) -> None:
    text = refused_file(version, ('stepSize="0.01"', f'stepSize="{step}"'))
    assert f'has a fixed step of {step} s' in text


@pytest.mark.parametrize('version', VERSIONS)
def test_an_identifier_that_names_no_file_is_refused(version: int) -> None:
    text = refused_file(version, ('modelIdentifier="pi"', 'modelIdentifier="my pi"'))
    assert "its modelIdentifier is 'my pi'" in text
    text = refused_file(version, (' modelIdentifier="pi"', ''))
    assert "its modelIdentifier is ''" in text


@pytest.mark.parametrize('end', ['min', 'max'])
def test_a_range_that_is_no_number_is_refused(end: str) -> None:
    file = controller_file(2)
    write_fmu(Path('pi.fmu'), 2, ('min="0" start="0.1"', f'{end}="much" start="0.1"'))
    with refused(ParameterError, 'fmu.parameters.pid.Kp', place='mine.yaml: line 6'):
        make_controller(file, SETTINGS.known)
