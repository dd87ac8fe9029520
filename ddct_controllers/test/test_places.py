# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An error is placed where the author of the controller can mend it."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ddct_controllers.architecture import make_architecture
from ddct_controllers.from_python import chosen_from
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.places import place_of_method
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
NOW = Measurement(
    step=100,
    engine_speed=200.0,
    shaft_speed=150.0,
    wheel_speed=16.0,
    vehicle_speed=5.0,
    engine_torque=100.0,
    slip_reference=[40.0],
    slip_reference_rate=[0.0],
)


class Mine(Controller):
    def reset(self):
        pass

    def update(self, measurement):
        return Command(float('nan'))


def test_the_place_of_a_class_is_its_file_and_line() -> None:
    place = place_of_method(make_controller(chosen_from(Mine), SETTINGS.known), 'update')
    assert place.startswith(f'{__file__} line ')


@pytest.fixture
def in_yaml(tmp_path: Path) -> str:
    """Return a file of a controller that requests more torque than a float can be."""
    file = tmp_path / 'mine.yaml'
    head = 'name: mine\nunits: {input: rpm, output: N m}\n'
    file.write_text(f'{head}polynomial: {{num: [1.0e+308], den: [1.0]}}\n')
    return str(file)


def test_the_place_of_a_controller_in_yaml_is_its_file_and_key(in_yaml: str) -> None:
    made = make_controller(in_yaml, SETTINGS.known)
    for method in ('__init__', 'reset', 'update', 'linear_model'):
        assert place_of_method(made, method) == f'{in_yaml} line 3 (polynomial)'


def test_the_place_of_a_linear_system_from_python_is_its_name() -> None:
    system = FactoredTransferFunction(-1.0, (), (0.0,))
    made = make_controller(chosen_from(system, 'quick'), SETTINGS.known)
    assert place_of_method(made, 'update') == "the linear system 'quick'"


def test_a_run_places_an_unusable_command_there_too(in_yaml: str) -> None:
    running = make_architecture(SETTINGS.known, make_controller(in_yaml, SETTINGS.known))
    with np.errstate(over='ignore'), pytest.raises(DdctError) as caught:
        running.update(NOW)
    assert str(caught.value).endswith(f'in {in_yaml} line 3 (polynomial)')
    assert 'its torque at step 100 is -inf' in str(caught.value)


def test_a_run_places_an_error_of_an_update_there_too(in_yaml: str) -> None:
    controller: Any = make_controller(in_yaml, SETTINGS.known)
    controller._filter = None
    with pytest.raises(DdctError, match=re.escape('in mine.yaml line 3 (polynomial)')):
        make_architecture(SETTINGS.known, controller).update(NOW)
