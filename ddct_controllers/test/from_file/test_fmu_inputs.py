# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each input of an FMU receives the signal that its file names; no FMU is needed."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from ddct_controllers.from_file.fmu import keys
from ddct_controllers.from_file.fmu.fmu_controller import FmuInput
from ddct_controllers.from_file.fmu.variables import AHEAD, SCALARS
from ddct_controllers.interface import Measurement
from ddct_controllers.registry import make_controller
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
NOW = Measurement(
    step=7,
    engine_speed=211.0,
    shaft_speed=173.0,
    wheel_speed=18.5,
    vehicle_speed=5.9,
    engine_torque=120.0,
    slip_reference=[31.0, 29.0, 26.0, 22.0],
    slip_reference_rate=[-200.0, -300.0, -400.0, -500.0],
    load_torque=64.0,
    open_loop_torque=105.0,
)
"""A measurement of which no two numbers are equal."""
SIGNALS = {
    'slip_error_rpm': rpm_from_rad_s(31.0 - (211.0 - 173.0)),
    'slip_speed_rad_s': 38.0,
    'engine_speed_rad_s': 211.0,
    'shaft_speed_rad_s': 173.0,
    'wheel_speed_rad_s': 18.5,
    'vehicle_speed_m_s': 5.9,
    'engine_torque_n_m': 120.0,
    'load_torque_n_m': 64.0,
    'open_loop_torque_n_m': 105.0,
    'slip_reference_rad_s': 31.0,
    'slip_reference_rad_s[0]': 31.0,
    'slip_reference_rad_s[1]': 29.0,
    'slip_reference_rad_s[3]': 22.0,
    'slip_reference_rate_rad_s2': -200.0,
    'slip_reference_rate_rad_s2[2]': -400.0,
}
"""Value of each signal in that measurement, by its name in a file."""


@pytest.fixture
def inputs_in_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a function that returns the inputs of an FMU for the signals in a file."""

    def variable(name: str, causality: str) -> SimpleNamespace:
        return SimpleNamespace(
            name=name, causality=causality, type='Real', unit=None, declaredType=None, shape=()
        )

    def inputs(*names: str) -> list[FmuInput]:
        found_inputs: list[FmuInput] = []
        known = {f'x{i}': variable(f'x{i}', 'input') for i in range(len(names))}
        known['u'] = variable('u', 'output')
        unit = SimpleNamespace(path=tmp_path / 'mine.fmu', variables=known)
        monkeypatch.setattr(keys, 'Fmu', lambda path: unit)

        def controller(file: object, unit: object, inputs: list[FmuInput], *_: object) -> Any:
            found_inputs.extend(inputs)
            return SimpleNamespace(code=None)

        monkeypatch.setattr(keys, 'FmuController', controller)
        (tmp_path / 'mine.fmu').write_bytes(b'PK')
        mapped = ', '.join(f"x{i}: '{name}'" for i, name in enumerate(names))
        file = tmp_path / 'mine.yaml'
        file.write_text(
            f'name: mine\nfmu: {{file: mine.fmu, inputs: {{{mapped}}}, '
            'outputs: {u: clutch_torque_n_m}}\n'
        )
        make_controller(str(file), SETTINGS.known)
        return found_inputs

    return inputs


def test_the_names_above_are_all_the_names() -> None:
    assert {name.partition('[')[0] for name in SIGNALS} == {*SCALARS, *AHEAD}


def test_each_input_receives_the_signal_of_its_name(inputs_in_file: Any) -> None:
    found_inputs = inputs_in_file(*SIGNALS)
    assert [each.variable.name for each in found_inputs] == [f'x{i}' for i in range(len(SIGNALS))]
    found = dict(zip(SIGNALS, (each.read(NOW) for each in found_inputs), strict=True))
    assert found == pytest.approx(SIGNALS)


@pytest.mark.parametrize(
    ('name', 'ahead'),
    [
        ('slip_reference_rad_s', 0),
        ('slip_reference_rad_s[3]', 3),
        ('slip_reference_rate_rad_s2[2]', 2),
        ('open_loop_torque_n_m', 0),
    ],
)
def test_the_preview_is_as_long_as_the_index(inputs_in_file: Any, name: str, ahead: int) -> None:
    assert [each.ahead for each in inputs_in_file(name)] == [ahead]
