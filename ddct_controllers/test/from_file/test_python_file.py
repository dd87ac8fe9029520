# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A Python file is a controller: the one class of `Controller` that it defines."""

import hashlib
from pathlib import Path

import pytest
from python_controllers import PROPORTIONAL
from refusals import refused

from ddct_controllers.check.checks import FAIL, PASS, check_controller
from ddct_controllers.registry import controller_label, controller_spec, make_controller
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
HEAD = """\
from dataclasses import dataclass
from ddct_controllers.interface import Command, Controller
from ddct_plant.base.options import Option
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / 'two words.v2.py'
    path.write_text(HEAD + PROPORTIONAL)
    return path


def test_it_is_called_as_its_class_and_takes_its_options(file: Path) -> None:
    settings = RunSettings(KnownSettings(load_scenario('thesis', ['controllers.Mine.gain=0.3'])))
    made = make_controller(str(file), settings.known)
    assert controller_label(str(file)) == made.registered_name == 'Mine'
    assert vars(made)['gain'] == 0.3
    with refused(ParameterError, key='controllers.Mine.gian'):
        make_controller(
            str(file),
            KnownSettings(load_scenario('thesis', ['controllers.Mine.gian=1'])),
        )


def test_it_is_identified_by_the_digest_of_its_file_and_an_edit_counts_at_once(file: Path) -> None:
    for text in (HEAD + PROPORTIONAL, (HEAD + PROPORTIONAL).replace('0.1', '0.2')):
        file.write_bytes(text.replace('\n', '\r\n').encode())
        made = make_controller(str(file), SETTINGS.known)
        digest = hashlib.sha256(file.read_bytes()).hexdigest()
        assert made.info('Mine')['controller_file_sha256'] == digest
        assert vars(made)['gain'] == (0.1 if '0.1' in text else 0.2)


def test_each_controller_has_the_file_and_what_lies_beside_it_for_itself(file: Path) -> None:
    beside = file.parent / 'beside_mine_7.py'
    beside.write_text('MADE = []\n')
    text = PROPORTIONAL.replace('self.gain = ', 'beside_mine_7.MADE.append(1); self.gain = ')
    file.write_text(f'import beside_mine_7\n{HEAD}{text}')
    spec = controller_spec(str(file))
    made = [make_controller(chosen, SETTINGS.known) for chosen in (str(file), spec, spec)]
    for each in made:
        assert type(each).update.__globals__['beside_mine_7'].MADE == [1]


@pytest.mark.parametrize(
    'more',
    [
        'from ddct_controllers.linear import PiController\n',
        '@dataclass\nclass Note:\n    text: str = ""\n',
        'class Base(Controller):\n    def reset(self):\n        pass\n',
        "if __name__ == '__main__':\n    raise SystemExit(3)\n",
    ],
    ids=['imported', 'other class', 'abstract', 'script'],
)
def test_the_class_is_the_one_controller_that_the_file_defines(file: Path, more: str) -> None:
    file.write_text(f'{HEAD}{more}{PROPORTIONAL}')
    assert controller_label(str(file)) == 'Mine'


@pytest.mark.parametrize(
    ('text', 'complaint'),
    [
        (HEAD, 'it defines no class of ddct_controllers.interface.Controller: write one'),
        (
            f'{HEAD}{PROPORTIONAL}{PROPORTIONAL.replace("Mine", "Other")}',
            'it defines 2 controllers, Mine, Other: keep one in each file',
        ),
        ('import no_such_module\n', "(ModuleNotFoundError: No module named 'no_such_module', in "),
        (HEAD + 'class Mine(Controller:\n', 'it cannot be loaded (SyntaxError: '),
        ('raise SystemExit(3)\n', 'it cannot be loaded (SystemExit: 3, in '),
    ],
)
def test_a_file_without_a_controller_is_an_error_of_one_line(
    file: Path, text: str, complaint: str
) -> None:
    file.write_text(text)
    with pytest.raises(DdctError) as caught:
        controller_spec(str(file))
    assert str(caught.value).startswith(f'controller file {file}: it ')
    assert complaint in str(caught.value)


def test_a_name_of_another_controller_is_refused(file: Path) -> None:
    file.write_text(HEAD + PROPORTIONAL.replace('Mine', 'pi'))
    with refused(ParameterError, key='name'):
        controller_spec(str(file))


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with refused(DdctError, place='mine.py'):
        controller_spec(str(tmp_path / 'mine.py'))


def test_an_error_in_it_is_found_with_its_line(file: Path) -> None:
    assert {each.state for each in check_controller(str(file), SETTINGS.known)} <= {
        PASS,
        'skipped',
    }
    file.write_text((HEAD + PROPORTIONAL).replace('-self.gain', 'self.gain'))
    found = {each.name: each.detail for each in check_controller(str(file), SETTINGS.known)}
    assert f'change the sign in {file} line 14; ' in found['sign']


@pytest.mark.process
@pytest.mark.parametrize(
    ('wrong', 'check', 'words'),
    [
        ('count.append(1) or Command(-len(count))', 'state', 'count'),
        ('Command(-self.gain * time.time())', 'determinism', 'it calls time.time in '),
        ('Command(-1 / 0)', 'answers', 'ZeroDivisionError: division by zero, in '),
    ],
)
def test_its_own_module_is_watched(file: Path, wrong: str, check: str, words: str) -> None:
    text = PROPORTIONAL.replace('Command(-self.gain * measurement.slip_error_rpm)', wrong)
    file.write_text(f'import time\ncount = []\n{HEAD}{text}')
    outcomes = {each.name: each for each in check_controller(str(file), SETTINGS.known)}
    assert outcomes[check].state == FAIL
    assert words in outcomes[check].detail
    assert f'{file} line 1' in outcomes[check].detail
