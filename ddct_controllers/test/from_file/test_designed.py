# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers in a file: read as written, refused by name, built by the registry."""

import dataclasses
import re

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.from_file.designed import DesignedController, load_designed
from ddct_controllers.linear import LinearController
from ddct_controllers.registry import controller_label, make_controller
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

G_C = FactoredTransferFunction(-0.1 / 3.0, (0.8361, (82.23, 2563.0)), (0.0, (5.325, 339.3)))
SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
TEXT = DesignedController('mine', G_C, {'method': 'by hand'}).to_yaml()


@pytest.fixture
def write(tmp_path):
    def write_text(text: str) -> str:
        path = tmp_path / 'any.yaml'
        path.write_text(text, encoding='utf-8')
        return str(path)

    return write_text


def test_a_controller_comes_back_to_the_bit(write):
    found = load_designed(write(TEXT))
    assert found == DesignedController('mine', G_C, {'method': 'by hand'})


def test_the_registry_builds_it_under_the_name_inside(write):
    file = write(TEXT)
    controller = make_controller(file, SETTINGS.known)
    assert isinstance(controller, LinearController)
    assert controller_label(file) == 'mine'
    assert controller_label('ls8') == 'ls8'


def test_its_numbers_are_options(write):
    file = write(TEXT)
    settings = RunSettings(
        KnownSettings(load_scenario('thesis', ['controllers.mine={gain: -0.5}']))
    )
    changed = make_controller(file, settings.known).linear_model()
    expected = LinearController(dataclasses.replace(G_C, gain=-0.5)).linear_model()
    assert changed is not None and np.array_equal(changed.c, expected.c)
    assert np.array_equal(changed.d, expected.d) and np.array_equal(changed.a, expected.a)


def test_it_takes_no_other_option(write):
    settings = RunSettings(
        KnownSettings(load_scenario('thesis', ['controllers.mine={gian: 2.0}']))
    )
    with refused(ParameterError, key='controllers.mine.gian'):
        make_controller(write(TEXT), settings.known)


def test_it_may_not_take_the_name_of_another_controller(write):
    with refused(ParameterError, key='name'):
        make_controller(write(TEXT.replace('name: mine', 'name: ls8')), SETTINGS.known)


@pytest.mark.parametrize(
    ('old', 'new', 'key', 'place'),
    [
        ('format: ddct-linear-controller-1', 'format: other', '', 'line 1'),
        ('input: rpm', 'input: rad/s', 'units', 'line 3'),
        ('name: mine', 'name: ../mine', '', 'line 2'),
        ('name: mine', 'name: 8', '', 'line 2'),
        ('name: mine\n', '', 'name', ''),
        ('  gain:', '  gian:', 'transfer_function.gain', 'line 4'),
        ('provenance:', 'origin:', 'origin', 'line 12'),
        ('- 0.8361', '- fast', 'transfer_function.numerator[0]: a coefficient', 'line 7'),
        ('- 0.8361', '- .nan', 'transfer_function.numerator[0]: a coefficient', 'line 7'),
        ('- 0.8361', '- [1.0, 2.0, 3.0]', 'transfer_function.numerator[0]', 'line 7'),
        ('- 0.0\n', '', 'transfer_function', 'line 4'),
        ('format:', '- format:', '', 'line 2'),
        ('name: mine', 'name: mine\nname: yours', '', 'line 3'),
        ('method: by hand', 'a: &a [*a]', '', 'line 12'),
        ('method: by hand', 'a: !!python/object/apply:os.getcwd []', '', 'line 12'),
    ],
)
def test_an_unusable_content_is_named_with_its_file(write, old, new, key, place):
    assert old in TEXT
    file = write(TEXT.replace(old, new))
    with refused(DdctError, key=key, place=place):
        make_controller(file, SETTINGS.known)


@pytest.mark.parametrize('gain', ['-1e-2', '-.01', '-1.0e-02', '-0.01'])
def test_numbers_are_written_as_in_scenarios(write, gain):
    text = re.sub('gain: .*', f'gain: {gain}', TEXT)
    assert load_designed(write(text)).transfer_function.gain == -0.01


def test_no_object_is_built_from_a_file(write, tmp_path):
    made = tmp_path / 'made'
    evil = f'a: !!python/object/apply:os.mkdir ["{made}"]'
    with pytest.raises(DdctError, match='the tag'):
        load_designed(write(TEXT.replace('method: by hand', evil)))
    assert not made.exists()


@pytest.mark.parametrize('text', ['', 'just words', '[1, 2]'])
def test_a_file_that_is_no_mapping_is_named(write, text):
    with refused(ParameterError, key='the file'):
        make_controller(write(text), SETTINGS.known)


def test_a_missing_file_is_named(tmp_path):
    with refused(DdctError, place='none.yaml'):
        make_controller(str(tmp_path / 'none.yaml'), SETTINGS.known)


def test_a_file_that_is_no_text_is_named(tmp_path):
    path = tmp_path / 'binary.yaml'
    path.write_bytes(b'\xff\xfe\x00')
    with pytest.raises(DdctError, match='not UTF-8'):
        make_controller(str(path), SETTINGS.known)
