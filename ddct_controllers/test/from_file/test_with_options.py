# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A file may give another controller other options, whatever that one is."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from python_controllers import IMPORTS, PROPORTIONAL
from refusals import refused

from ddct_controllers.from_file.with_options import with_options_text
from ddct_controllers.interface import ControllerContext
from ddct_controllers.linear import PiController
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.registry import controller_spec, make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
PI_GAINS = {'proportional_gain': 0.25, 'integral_gain': 0.5}
LINEAR = 'units: {input: rpm, output: N m}\npolynomial: {num: [-0.1, -1.0], den: [1, 0]}\n'
Write = Callable[[str, str], str]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Return a function that writes a file by its name, and returns its path."""

    def write_text(name: str, text: str) -> str:
        (tmp_path / name).write_text(text, encoding='utf-8')
        return str(tmp_path / name)

    return write_text


def test_a_packaged_controller_has_the_gains_of_the_file(write: Write) -> None:
    file = write('tuned.yaml', with_options_text('tuned', 'pi', PI_GAINS))
    controller = make_controller(file, SETTINGS.known)
    assert isinstance(controller, PiController) and controller.gains() == PI_GAINS
    assert controller.registered_name == 'tuned'


def test_whole_numbers_stay_whole(write: Write) -> None:
    text = with_options_text('short', 'mpc3', {'prediction_steps': 9, 'output_weight': 1})
    spec = controller_spec(write('short.yaml', text))
    assert isinstance(spec(ControllerContext(SETTINGS.known, {})), MpcController)
    options = spec.options or {}
    assert (options['prediction_steps'].default, options['output_weight'].default) == (9, 1.0)
    assert options['prediction_steps'].kind is int and options['output_weight'].kind is float


def test_its_options_can_be_set_again(write: Write) -> None:
    file = write('tuned.yaml', with_options_text('tuned', 'pi', PI_GAINS))
    changed = RunSettings(
        KnownSettings(load_scenario('thesis', ['controllers.tuned={integral_gain: 0.0}']))
    )
    assert make_controller(file, changed.known).gains() == {**PI_GAINS, 'integral_gain': 0.0}


def test_files_of_other_kinds_are_relative_to_it(write: Write) -> None:
    write('mine.yaml', 'name: mine\n' + LINEAR)
    write('mine.py', IMPORTS + PROPORTIONAL)
    linear = write('a.yaml', with_options_text('a', 'mine.yaml', {'num_0': -0.2}))
    model = make_controller(linear, SETTINGS.known).linear_model()
    assert model is not None and np.array_equal(model.d, [[-0.2]])
    python = make_controller(
        write('b.yaml', with_options_text('b', 'mine.py', {'gain': 0.7})), SETTINGS.known
    )
    assert getattr(python, 'gain', None) == 0.7
    assert set(python.digests) == {'controller_file_sha256', 'base_controller_file_sha256'}


@pytest.mark.parametrize(
    ('controller', 'options', 'key'),
    [
        ('pi', {'proportional': 1.0}, 'with_options.options.proportional'),
        ('pi', {'proportional_gain': -1.0}, 'with_options.options.proportional_gain'),
        ('hinf_sampled', {'gain': -1.0}, 'with_options.options.gain'),
        ('', {}, 'with_options.controller'),
        ('other.yaml', {}, 'with_options.controller'),
    ],
)
def test_a_mistake_names_key_and_line(
    write: Write, controller: str, options: dict[str, float], key: str
) -> None:
    write('other.yaml', with_options_text('other', 'wrong.yaml', PI_GAINS))
    file = write('wrong.yaml', with_options_text('wrong', controller, options))
    line = 5 if options else 3
    with refused(ParameterError, key=key, place=f'wrong.yaml: line {line}'):
        controller_spec(file)
