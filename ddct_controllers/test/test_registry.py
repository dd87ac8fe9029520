# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers are found by name; one that cannot be built raises an error with the reason."""

import importlib.metadata
from typing import Any, ClassVar

import numpy as np
import pytest
from refusals import refused

from ddct_controllers import plugins
from ddct_controllers.interface import Command, Controller
from ddct_controllers.plugins import CONTROLLERS
from ddct_controllers.registry import (
    controller_names,
    make_controller,
    require_known_controllers,
)
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.options import Option
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))


class Third(Controller):
    def reset(self):
        pass

    def update(self, measurement):
        return Command(1.0)


def make_third(context):
    return Third()


class Declaring(Third):
    options: ClassVar[dict[str, Option]] = {
        'gain': Option(0.1, 'torque per slip error', 'N m/rpm', at_least=0.0),
        'steps': Option(3, 'that it waits', at_most=9),
        'limit_n_m': Option(None, 'of the torque', 'N m'),
    }

    def __init__(self, context):
        self.taken = context.gains


def leave(context):
    raise SystemExit(3)


def make_nothing(context):
    return None


@pytest.fixture
def add_entry_point(monkeypatch):
    def add(name, value):
        point = importlib.metadata.EntryPoint(name, value, CONTROLLERS.group)
        monkeypatch.setattr(
            plugins, '_installed', lambda _: importlib.metadata.EntryPoints([point])
        )

    return add


def test_every_name_builds_a_controller():
    for name in controller_names():
        assert isinstance(make_controller(name, SETTINGS.known), Controller)


def test_an_unknown_name_lists_the_known_ones():
    with refused(ParameterError, 'ls99'):
        make_controller('ls99', SETTINGS.known)


@pytest.mark.parametrize('name', ['mine.fmu', 'build/libmine', '/dev/fd/63'])
def test_a_file_of_another_kind_leads_to_those_that_are_needed(name):
    with refused(ParameterError, name) as caught:
        make_controller(name, SETTINGS.known)
    assert 'docs/controllers/files.md' in str(caught.value)


def test_the_gain_of_a_printed_controller_is_its_only_option():
    settings = RunSettings(
        KnownSettings(load_scenario('thesis', ['controllers.ls8={gain: -0.028936}']))
    )
    twice, once = make_controller('ls8', settings.known), make_controller('ls8', SETTINGS.known)
    assert np.allclose(twice.linear_model().c, 2.0 * once.linear_model().c, rtol=1e-12)
    wrong = RunSettings(KnownSettings(load_scenario('thesis', ['controllers.ls8={pole: 2.0}'])))
    with refused(ParameterError, key='controllers.ls8.pole'):
        make_controller('ls8', wrong.known)


def test_a_third_partys_controller_is_listed_and_built(add_entry_point):
    add_entry_point('third', f'{__name__}:make_third')
    assert controller_names()[-1] == 'third'
    assert type(make_controller('third', SETTINGS.known)).__name__ == 'Third'


def test_installed_packages_are_searched_once_until_another_is_added(tmp_path, monkeypatch):
    searches = []
    search = importlib.metadata.entry_points

    def counted(**group):
        searches.append(group)
        return search(**group)

    monkeypatch.setattr(importlib.metadata, 'entry_points', counted)
    monkeypatch.syspath_prepend(str(tmp_path))
    before = [controller_names() for _ in range(3)]
    assert len(searches) == 1
    assert all('later' not in names for names in before)
    added = tmp_path / 'later-1.0.dist-info'
    added.mkdir()
    (added / 'METADATA').write_text('Metadata-Version: 2.1\nName: later\nVersion: 1.0\n')
    (added / 'entry_points.txt').write_text(f'[{CONTROLLERS.group}]\nlater = later:make\n')
    assert 'later' in controller_names()
    assert len(searches) == 2


def test_a_third_party_cannot_replace_one_of_ours(add_entry_point):
    add_entry_point('pi', f'{__name__}:make_third')
    assert controller_names().count('pi') == 1
    assert type(make_controller('pi', SETTINGS.known)).__name__ == 'PiController'


@pytest.mark.parametrize(
    ('value', 'key'),
    [
        ('no_such_module:make', 'no_such_module:make'),
        (f'{__name__}:no_such_function', 'test_registry:no_such_function'),
        (f'{__name__}:make_nothing', 'test_registry:make_nothing'),
        (f'{__name__}:leave', 'test_registry:leave'),
    ],
)
def test_a_broken_entry_point_is_named(add_entry_point, value, key):
    add_entry_point('third', value)
    with refused(DdctError, key, place="controller 'third'"):
        make_controller('third', SETTINGS.known)


@pytest.mark.parametrize('name', ['../evil', '/tmp/evil', '.hidden', 'a b', 'x' * 300])
def test_an_entry_point_cannot_name_a_folder_elsewhere(add_entry_point, name):
    add_entry_point(name, f'{__name__}:make_third')
    with refused(ParameterError, key='controller name'):
        make_controller(name, SETTINGS.known)


@pytest.mark.parametrize(
    ('attribute', 'value'),
    [
        *(('preview_steps', value) for value in (-1, 1.5, '3', None, True)),
        *(('commands_engine', value) for value in (1, 'no', None)),
    ],
)
def test_a_declaration_of_the_wrong_type_names_the_controller(
    add_entry_point, monkeypatch, attribute, value
):
    monkeypatch.setattr(Third, attribute, value)
    add_entry_point('third', f'{__name__}:make_third')
    with refused(DdctError, key=attribute, place="controller 'third'"):
        make_controller('third', SETTINGS.known)


@pytest.mark.parametrize(
    ('method', 'answer', 'key'),
    [
        ('gains', {'gain': 'high'}, 'gains()'),
        ('gains', None, 'gains()'),
        ('info', {'version': 2}, 'info()'),
        ('gains', KeyError('gain'), 'test_registry:make_third'),
        ('info', SystemExit(3), 'test_registry:make_third'),
    ],
)
def test_declarations_of_a_controller_are_checked_when_it_is_made(
    add_entry_point, monkeypatch, method, answer, key
):
    def answers(*_):
        if isinstance(answer, BaseException):
            raise answer
        return answer

    monkeypatch.setattr(Third, method, answers)
    add_entry_point('third', f'{__name__}:make_third')
    with refused(DdctError, key, place="controller 'third'"):
        make_controller('third', SETTINGS.known)


def test_an_option_of_ours_is_checked_though_its_controller_does_not_run(add_entry_point):
    add_entry_point('broken', 'no_such_module:make')
    require_known_controllers(load_scenario('thesis', ['controllers.broken.gain=1']), [])
    typo = load_scenario('thesis', ['controllers.mpc3.delay_in_modell=true'])
    with refused(ParameterError, key='controllers.mpc3.delay_in_modell'):
        require_known_controllers(typo, ['ls8'])


def test_a_controller_has_the_name_under_which_it_was_requested(add_entry_point):
    add_entry_point('third', f'{__name__}:make_third')
    assert make_controller('third', SETTINGS.known).registered_name == 'third'
    assert make_controller('ls8', SETTINGS.known).registered_name == 'ls8'


def test_declared_options_reach_a_third_partys_controller_checked_and_whole(add_entry_point):
    add_entry_point('mine', f'{__name__}:Declaring')
    settings = RunSettings(KnownSettings(load_scenario('thesis', ['controllers.mine.gain=2'])))
    expected = {'gain': 2.0, 'steps': 3, 'limit_n_m': None}
    plain: Any = make_controller('mine', settings.known)
    changed: Any = make_controller('mine', settings.known, {'steps': 4, 'limit_n_m': 5.0})
    assert plain.taken == expected
    assert changed.taken == {**expected, 'steps': 4, 'limit_n_m': 5.0}


@pytest.mark.parametrize(
    ('change', 'complaint'),
    [
        ('gian=2', 'controllers.mine.gian is not a key of mine: it has gain, steps, limit_n_m'),
        ('gain=-1', 'controllers.mine.gain is -1 N m/rpm: it must be at least 0'),
        ('steps=1.5', 'controllers.mine.steps is 1.5: give a whole number'),
        ('limit_n_m=high', "controllers.mine.limit_n_m is 'high': give a number in N m"),
    ],
)
def test_a_bad_option_of_a_third_partys_controller_is_named(add_entry_point, change, complaint):
    add_entry_point('mine', f'{__name__}:Declaring')
    settings = RunSettings(KnownSettings(load_scenario('thesis', [f'controllers.mine.{change}'])))
    with pytest.raises(ParameterError) as caught:
        make_controller('mine', settings.known)
    assert str(caught.value) == complaint


@pytest.mark.parametrize('factory', ['make_third', 'Third'])
def test_an_option_that_a_third_partys_controller_does_not_declare_is_refused(
    add_entry_point, factory
):
    add_entry_point('third', f'{__name__}:{factory}')
    settings = RunSettings(KnownSettings(load_scenario('thesis', ['controllers.third.gian=2.5'])))
    with pytest.raises(ParameterError) as caught:
        make_controller('third', settings.known)
    assert str(caught.value) == (
        'controllers.third: gian given, but third takes no options: declare it, in its class: '
        "options = {'gian': Option(2.5, 'what it is', 'its unit')}"
    )


@pytest.mark.parametrize('options', [{'gain': 0.1}, ['gain'], 3])
def test_options_that_are_no_declaration_name_the_controller(
    add_entry_point, monkeypatch, options
):
    monkeypatch.setattr(Third, 'options', options)
    add_entry_point('third', f'{__name__}:Third')
    with refused(DdctError, key='options', place="controller 'third'"):
        make_controller('third', SETTINGS.known)


def test_a_controller_is_not_made_from_the_true_settings_of_a_run() -> None:
    true: Any = SETTINGS
    with refused(ParameterError, 'settings') as caught:
        make_controller('pi', true)
    assert 'give settings.known' in str(caught.value)
