"""One table decides what a controller file is."""

import re

import pytest

from ddct_controllers.from_file.kinds import KINDS
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

SETTINGS = RunSettings(load_scenario('thesis'))
CHOICES = ', '.join(KINDS)


@pytest.mark.parametrize(
    ('text', 'complaint'),
    [
        ('name: mine\n', f'there is no kind of controller: give one of {CHOICES}'),
        (
            'name: mine\ntransfer_funktion: {}\n',
            f"line 2: 'transfer_funktion' is no kind of controller: give one of {CHOICES}",
        ),
        (
            'name: mine\npolynomial: {}\nstate_space: {}\n',
            f'line 3: state_space beside polynomial: keep one of {CHOICES}',
        ),
    ],
)
def test_a_file_of_none_or_two_kinds_says_the_line_and_the_choices(tmp_path, text, complaint):
    path = tmp_path / 'mine.yaml'
    path.write_text(text)
    with pytest.raises(ParameterError, match=re.escape(f'controller file {path}: {complaint}')):
        make_controller(str(path), SETTINGS)
