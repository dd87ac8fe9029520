# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`--list` and `compare` print a controller's origin, or the line that declares it."""

import io
from pathlib import Path

from ddct_bringup.run.options import print_computed_from
from ddct_controllers.interface import SCENARIO, THESIS
from ddct_controllers.registry import factory_spec


def printed(*names):
    stream = io.StringIO()
    print_computed_from(names, stream)
    return stream.getvalue().replace('\n  ', ' ').splitlines()


def of_class(computed_from=None):
    attributes = {} if computed_from is None else {'computed_from': computed_from}
    return factory_spec('my_slip', type('Mine', (), attributes), 'mine.py')


def test_a_class_without_origin_is_named_with_the_line_to_write_and_the_reason():
    (line,) = printed(of_class())
    assert 'whether another driveline in the scenario changes their gains: my_slip' in line
    assert "write into the class computed_from = 'scenario' if they are computed from" in line
    assert "computed_from = 'thesis' if they are fixed numbers" in line


def test_the_line_to_write_ends_the_printed_line():
    assert printed(of_class(SCENARIO)) == ['computed from scenario: my_slip']
    assert printed(of_class(THESIS), 'pi') == ['computed from thesis: my_slip, pi']


def test_a_controller_file_is_not_named_as_one_without_origin():
    file = Path(__file__).parents[3] / 'docs' / 'templates' / 'transfer_function.yaml'
    assert printed(str(file)) == [
        'as their files have them, whatever driveline the scenario has: mine'
    ]


def test_the_class_in_a_python_file_can_state_its_origin(tmp_path):
    file = tmp_path / 'mine.py'
    file.write_text(
        'from ddct_controllers.interface import Command, Controller\n'
        'class Mine(Controller):\n'
        '    def reset(self):\n        pass\n'
        '    def update(self, measurement):\n        return Command(0.0)\n',
        encoding='utf-8',
    )
    (line,) = printed(str(file))
    assert 'changes their gains: Mine (write into the class' in line


def test_a_controller_that_cannot_be_loaded_is_listed_as_such():
    assert printed('nobody') == ['cannot be loaded, as the options of controllers say: nobody']
