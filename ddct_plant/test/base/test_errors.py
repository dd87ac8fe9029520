# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Errors have a key and a place, and lose neither on their way to the user."""

import pickle

import pytest

from ddct_plant.base.errors import (
    DdctError,
    ParameterError,
    require_choice,
    require_name,
    require_number,
    require_signal,
    without_folders,
)
from ddct_plant.base.option import Option
from ddct_plant.base.timebase import steps_in
from ddct_plant.files.input_file import located

ERROR = ParameterError('gain is -1: give a gain', key='gain', place='line 3')


def test_the_text_begins_with_the_place() -> None:
    assert str(ERROR) == 'line 3: gain is -1: give a gain'
    assert (ERROR.key, ERROR.place) == ('gain', 'line 3')


def test_an_error_without_key_and_place_is_its_text() -> None:
    error = DdctError('the disk is full')
    assert (str(error), error.key, error.place) == ('the disk is full', '', '')


def test_a_place_around_an_error_keeps_type_key_and_inner_place() -> None:
    around = ERROR.at('mine.yaml')
    assert type(around) is ParameterError
    assert str(around) == 'mine.yaml: line 3: gain is -1: give a gain'
    assert (around.key, around.place) == ('gain', 'mine.yaml: line 3')


def test_a_located_error_has_the_line_of_its_key_whatever_its_words_are() -> None:
    def read() -> None:
        with located('mine.yaml', {'gain': 7, 'rate': 8}):
            raise ParameterError('rate and more: give less', key='gain')

    with pytest.raises(ParameterError) as caught:
        read()
    assert (caught.value.key, caught.value.place) == ('gain', 'mine.yaml: line 7')


def test_key_and_place_reach_another_process() -> None:
    there = pickle.loads(pickle.dumps(ERROR))
    assert (str(there), there.key, there.place) == (str(ERROR), ERROR.key, ERROR.place)


@pytest.mark.parametrize(
    'refuse',
    [
        lambda: require_number('gain', 'high'),
        lambda: require_number('gain', float('nan')),
        lambda: require_number('gain', 0.0, above=0.0),
        lambda: require_number('gain', -1.0, at_least=0.0),
        lambda: require_number('gain', 2.0, at_most=1.0),
        lambda: require_name('gain', '../gain'),
        lambda: Option((), '', many=True, rising=True).checked('gain', [1.0, 1.0]),
        lambda: require_choice('gain', 'high', ['low']),
        lambda: require_signal('gain', float('inf')),
        lambda: steps_in('gain', 0.005),
    ],
)
def test_each_check_of_a_value_gives_its_name_as_the_key(refuse) -> None:
    with pytest.raises(DdctError) as caught:
        refuse()
    assert caught.value.key == 'gain'


def test_the_reason_of_a_run_names_files_without_folders():
    text = 'controller file /home/me/mine.yaml: line 2: a/b is 1/2, in /tmp/x/y.py line 3'
    expected = 'controller file mine.yaml: line 2: a/b is 1/2, in y.py line 3'
    assert without_folders(text) == expected
    windows = (
        r'controller file C:\Users\me\mine.yaml: line 2: \x1b\x1b is no name, in d:/x/y.py line 3'
    )
    expected = r'controller file mine.yaml: line 2: \x1b\x1b is no name, in y.py line 3'
    assert without_folders(windows) == expected


def test_the_reason_of_a_run_keeps_the_names_of_ros():
    """So a command in it can be given as it stands."""
    text = (
        'the nodes /car/clutch and /hand/clutch: stop one; a graph with /car/clock runs: give '
        '--ros-args -r __ns:=/car -r /clock:=/car/clock, or wait for /tmp/x/clock.yaml'
    )
    assert without_folders(text) == text.replace('/tmp/x/', '')
