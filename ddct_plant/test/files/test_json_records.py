# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Dataclasses go to JSON and come back, and what is none is refused in one line with its key."""

import enum
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import pytest

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.json_records import (
    Inline,
    from_json,
    json_text,
    read_json,
    to_json,
    write_json,
)


class Side(enum.Enum):
    """Side of a gearbox."""

    ODD = 'odd'
    EVEN = 'even'


@dataclass(frozen=True)
class Range:
    """Range that refuses to be empty."""

    low: float
    high: float | None = None

    def __post_init__(self) -> None:
        if self.high is not None and self.high < self.low:
            raise ParameterError(f'high is {self.high}: it must be at least low', key='high')


@dataclass(frozen=True)
class Measured:
    """Half of a union."""

    linear: Literal[True]
    gain: float


@dataclass(frozen=True)
class Unmeasured:
    """Other half."""

    linear: Literal[False] | None
    gain: None


@dataclass(frozen=True)
class Record:
    """One field of each kind."""

    name: str
    runs: int
    valid: bool
    gain: float
    side: Side
    state: Literal['engaged', 'failed']
    pair: tuple[str, float]
    factors: tuple[float | tuple[float, float], ...]
    ranges: Sequence[Range]
    loops: list[Measured | Unmeasured]
    values: Mapping[str, list[float | None]]
    settings: dict[str, Any]
    computed: float = field(init=False, default=3.0)


RECORD = Record(
    name='ä',
    runs=2,
    valid=True,
    gain=0.1,
    side=Side.EVEN,
    state='failed',
    pair=('a', 1.5),
    factors=(1.0, (2.0, 3.0)),
    ranges=(Range(1.0), Range(1.0, 2.0)),
    loops=[Measured(True, 1.0), Unmeasured(False, None), Unmeasured(None, None)],
    values={'x': [1.0, None]},
    settings={'any': [1, {'b': None}]},
)
PLAIN = {
    'name': 'ä',
    'runs': 2,
    'valid': True,
    'gain': 0.1,
    'side': 'even',
    'state': 'failed',
    'pair': ['a', 1.5],
    'factors': [1.0, [2.0, 3.0]],
    'ranges': [{'low': 1.0, 'high': None}, {'low': 1.0, 'high': 2.0}],
    'loops': [
        {'linear': True, 'gain': 1.0},
        {'linear': False, 'gain': None},
        {'linear': None, 'gain': None},
    ],
    'values': {'x': [1.0, None]},
    'settings': {'any': [1, {'b': None}]},
}


def changed(path: str, value: Any) -> dict[str, Any]:
    """Return the plain record with one value replaced; `...` removes it."""
    data: Any = json.loads(json.dumps(PLAIN))
    *steps, last = [int(step) if step.isdigit() else step for step in path.split('/')]
    inner = data
    for step in steps:
        inner = inner[step]
    if value is ...:
        del inner[last]
    else:
        inner[last] = value
    return data


def test_a_record_becomes_plain_data_with_its_fields_as_keys_in_their_order():
    assert to_json(RECORD) == PLAIN
    assert list(to_json(RECORD)) == list(PLAIN)


def test_a_record_comes_back_as_it_was():
    assert from_json(Record, PLAIN, 'x.json') == RECORD


@dataclass(frozen=True)
class Named:
    """Record with the keys of another one between its own."""

    name: str
    limits: Inline[Range]
    runs: int = 0


def test_keys_of_an_inline_record_stand_among_those_around_it():
    plain = {'name': 'a', 'low': 1.0, 'high': None, 'runs': 3}
    record = Named('a', Range(1.0), 3)
    assert list(to_json(record).items()) == list(plain.items())
    assert from_json(Named, plain, 'x.json') == record
    for key, complaint in (('low', 'the key low is missing'), ('name', 'the key name is missing')):
        with pytest.raises(DdctError, match=f'^x.json: {complaint}$'):
            from_json(Named, {k: v for k, v in plain.items() if k != key}, 'x.json')
    with pytest.raises(DdctError, match="^x.json: high is 'b': give a number or null$"):
        from_json(Named, plain | {'high': 'b'}, 'x.json')
    with pytest.raises(DdctError, match='^x.json: unknown key limits: known: name, low, high'):
        from_json(Named, plain | {'limits': {}}, 'x.json')


def test_numbers_of_numpy_are_written_as_those_of_python():
    values = {'a': np.float64(0.1), 'b': np.int64(3), 'c': np.bool_(True), 'd': np.eye(2)}
    plain = {'a': 0.1, 'b': 3, 'c': True, 'd': [[1.0, 0.0], [0.0, 1.0]]}
    assert json_text(values) == json_text(plain)


def test_a_whole_number_in_place_of_a_float_stays_whole():
    text = json_text(from_json(Range, {'low': 1, 'high': 2}, 'x.json'))
    assert json.loads(text) == {'low': 1, 'high': 2}
    assert '.0' not in text


@pytest.mark.parametrize('number', [math.nan, math.inf])
def test_what_json_has_no_number_for_is_not_written(number, tmp_path):
    with pytest.raises(ValueError, match='JSON'):
        write_json(str(tmp_path / 'x.json'), Range(number))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize('thing', [object(), {1.5: 2}, Range, {'a': {3}}])
def test_what_has_no_form_in_json_is_a_fault_of_the_program(thing):
    with pytest.raises(TypeError):
        to_json(thing)


@pytest.mark.parametrize(
    ('path', 'value', 'complaint'),
    [
        ('name', 5, 'name is 5: give a text'),
        ('pair/1', '{}', "pair[1] is '{}': give a number"),
        ('name', None, 'name is null: give a text'),
        ('runs', 2.0, 'runs is 2.0: give a whole number'),
        ('runs', True, 'runs is True: give a whole number'),
        ('valid', 1, 'valid is 1: give true or false'),
        ('gain', '0.1', "gain is '0.1': give a number"),
        ('gain', False, 'gain is False: give a number'),
        ('gain', 1e999, 'gain is inf: give a number'),
        pytest.param('gain', 10**400, 'gain is 10000', id='beyond doubles'),
        ('side', 'left', 'side is \'left\': give "odd" or "even"'),
        ('state', 'lost', 'state is \'lost\': give "engaged" or "failed"'),
        ('pair', ['a'], 'pair has 1 values: give 2'),
        ('pair/1', 'b', "pair[1] is 'b': give a number"),
        ('factors/0', {}, 'factors[0] is an object: give a number or a list'),
        ('factors/1/1', None, 'factors[1][1] is null: give a number'),
        ('ranges', {}, 'ranges is an object: give a list'),
        ('ranges/1', [], 'ranges[1] is a list: give an object'),
        ('ranges/1/high', 'c', "ranges[1].high is 'c': give a number or null"),
        ('ranges/1/high', 0.5, 'ranges[1]: high is 0.5: it must be at least low'),
        ('ranges/0/hihg', 1, 'unknown key ranges[0].hihg: did you mean high?'),
        ('ranges/0/high', ..., 'the key ranges[0].high is missing'),
        ('loops/0/gain', 'a', "loops[0].gain is 'a': give a number"),
        ('loops/1/gain', 1.0, 'loops[1].linear is False: give true'),
        ('loops/2', 7, 'loops[2] is 7: give an object'),
        ('values', [], 'values is a list: give an object'),
        ('values/x', 1.0, 'values.x is 1.0: give a list'),
        ('values/x/1', 'n', "values.x[1] is 'n': give a number or null"),
        ('computed', 3.0, 'unknown key computed: known: '),
        ('gain', ..., 'the key gain is missing'),
    ],
)
def test_what_is_no_record_is_refused_in_one_line_with_file_and_key(path, value, complaint):
    with pytest.raises(DdctError) as caught:
        from_json(Record, changed(path, value), 'out/x.json')
    assert str(caught.value).startswith(f'out/x.json: {complaint}')
    assert str(caught.value).isprintable()
    assert caught.value.place.startswith('out/x.json')
    assert caught.value.key


def test_data_of_another_shape_than_an_object_are_refused():
    with pytest.raises(DdctError, match=r'^x\.json: it is a list: give an object$'):
        from_json(Range, [], 'x.json')
    with pytest.raises(DdctError, match=r'^x\.json: \[1\]\.low is null: give a number$'):
        from_json(list[Range], [{'low': 1, 'high': None}, {'low': None, 'high': 1}], 'x.json')


def test_what_the_record_itself_refuses_is_named_alone_at_the_top():
    with pytest.raises(DdctError, match=r'^x\.json: high is 1: it must be at least low$'):
        from_json(Range, {'low': 2, 'high': 1}, 'x.json')


def test_a_type_without_form_in_json_is_a_fault_of_the_program():
    with pytest.raises(TypeError):
        from_json(set[str], [], 'x.json')


def test_a_newer_schema_version_is_reported_before_its_unknown_keys():
    with pytest.raises(DdctError, match=r'^x\.json: schema_version is 3, .* update the project$'):
        from_json(Range, {'schema_version': 3, 'colour': 1}, 'x.json', newest=2)


def test_a_file_comes_back(tmp_path):
    path = tmp_path / 'x.json'
    write_json(str(path), RECORD)
    assert path.read_text(encoding='utf-8') == json.dumps(PLAIN, indent=2) + '\n'
    assert read_json(Record, path) == RECORD


@pytest.mark.parametrize(
    ('content', 'complaint'),
    [(None, 'cannot be read (No such file'), ('{"low": 1', 'not valid JSON'), ('{}', 'the key')],
)
def test_a_file_that_is_none_is_refused_with_its_name(content, complaint, tmp_path):
    path = tmp_path / 'x.json'
    if content is not None:
        path.write_text(content)
    with pytest.raises(DdctError) as caught:
        read_json(Range, path)
    assert str(caught.value).startswith(f'{path}: {complaint}')


@pytest.mark.parametrize(('content', 'key'), [(None, ''), ('[', ''), ('{"low": "a"}', 'low')])
def test_the_advice_of_a_reader_ends_each_error_of_its_file(content, key, tmp_path):
    path = tmp_path / 'x.json'
    if content is not None:
        path.write_text(content)
    with pytest.raises(DdctError) as plain:
        read_json(Range, path)
    with pytest.raises(DdctError) as advised:
        read_json(Range, path, advice='make it anew')
    assert str(advised.value) == f'{plain.value}: make it anew'
    assert advised.value.place == plain.value.place == str(path)
    assert advised.value.key == plain.value.key == key


@dataclass(frozen=True)
class Optional:
    """Values that may be missing altogether."""

    values: Mapping[str, float] | None


@pytest.mark.parametrize('values', [None, {}, {'a': 1.0}])
def test_a_mapping_may_be_null(values):
    assert from_json(Optional, {'values': values}, 'x.json') == Optional(values)
    with pytest.raises(DdctError, match=r"^x\.json: values\.a is 'b': give a number$"):
        from_json(Optional, {'values': {'a': 'b'}}, 'x.json')
