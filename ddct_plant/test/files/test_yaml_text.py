# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""YAML becomes plain values as YAML 1.2 has them, or is refused with its line."""

import math
import runpy

import pytest
import yaml

from ddct_plant.base.errors import DdctError
from ddct_plant.files import yaml_text
from ddct_plant.files.yaml_text import dump_yaml, parse_yaml, parse_yaml_with_lines


@pytest.fixture(params=['C', 'Python'])
def parse(request, monkeypatch):
    """Return the reader on each parser: PyYAML may come without the one in C."""
    if request.param == 'Python':
        monkeypatch.delattr(yaml, 'CSafeLoader')
    return runpy.run_path(yaml_text.__file__)['parse_yaml']


@pytest.mark.parametrize(
    ('text', 'value'),
    [
        ('', None),
        ('a:', {'a': None}),
        ('[1, -2, +3, 0x10, 0o17, 010]', [1, -2, 3, 16, 15, 10]),
        ('[1e-3, -1e-2, .5, 1., +1.5E+2]', [1e-3, -1e-2, 0.5, 1.0, 150.0]),
        ('[.inf, -.INF]', [math.inf, -math.inf]),
        ('[!!float 3, !!int 0x10, !!bool true, !!null ~, !!str 5]', [3.0, 16, True, None, '5']),
        ('[true, False, null, ~]', [True, False, None, None]),
        (
            '[yes, "on", 1:30, 1_000, 2024-01-01, "1"]',
            ['yes', 'on', '1:30', '1_000', '2024-01-01', '1'],
        ),
        ('{a: {b: [c]}, <<: d}', {'a': {'b': ['c']}, '<<': 'd'}),
        ('|\n 12\n', '12\n'),
        ('{a: &x [1], b: *x}', {'a': [1], 'b': [1]}),
        ('"\\e[31m \\u00e4"', '\x1b[31m ä'),
    ],
)
def test_the_values_are_those_of_yaml_1_2(parse, text, value):
    assert parse(text) == value


def test_nan_is_a_number():
    assert math.isnan(parse_yaml('.nan'))


@pytest.mark.parametrize(
    ('text', 'line', 'complaint'),
    [
        ('a: 1\nb: 2\na: 3', 3, "the key 'a' is given twice, first in line 1"),
        ('a: {b: 1,\n b: 2}', 2, "the key 'b' is given twice, first in line 1"),
        ('a: 1\n"a": 2', 2, "the key 'a' is given twice"),
        ('a:\n- b: 1\n- {c: 1, c: 2}', 3, "the key 'c' is given twice"),
        ('a: *b', 1, 'found undefined alias'),
        ('b: 1\na: &a [*a]', 2, 'an alias stands in what it stands for'),
        ('a: !!python/object/apply:os.getcwd []', 1, "the tag 'tag:yaml.org,2002:python/"),
        ('a: !!python/name:os.getcwd', 1, 'the tag'),
        ('!mine 1', 1, "the tag '!mine'"),
        ('a: !!binary aGk=', 1, 'values without tags'),
        ('a: !!set {b}', 1, 'values without tags'),
        ('a: 1\nb: !!bool maybe', 2, "'maybe' has another form than its tag says"),
        ('a: 1\n!!int ten: 1', 2, "'ten' has another form than its tag says"),
        ('a: !!int {b: 1}', 1, 'values without tags'),
        ('a: 1\n---\nb: 2', 2, 'found another document'),
        ('[1]: 2', 1, 'unhashable key: give texts as keys'),
        ('a: 1\nb: [}', 2, 'check quotes, brackets and indentation'),
        ('a: "b\nc: 1', 2, 'unexpected end of stream'),
        ('a: 1\n b: 2', 2, 'mapping values are not allowed'),
        ('ä: 1\nb: \udcff', None, "can't encode|control character"),
        ('ä: 1\nb: \x1b[31m', 2, 'a control character: delete it'),
    ],
)
def test_what_is_no_plain_value_is_refused_in_one_line_with_its_place(
    parse, text, line, complaint
):
    with pytest.raises(DdctError) as caught:
        parse(text)
    message = str(caught.value)
    if line:
        assert caught.value.place == f'line {line}'
    assert any(each in message for each in complaint.split('|')), message
    assert message.isprintable()
    assert len(message) < 300


@pytest.mark.parametrize('text', ['1e-3', '0o7', '-.5', '1.', 'yes', '1', 'null', '', '~', '.inf'])
def test_text_comes_back_as_text_and_numbers_to_the_last_bit(text):
    content = {'text': text, 'numbers': [1e-5, 5e-324, 1e300, 0.1, 3], 'none': None, 'on': True}
    assert parse_yaml(dump_yaml(content)) == content


def test_an_object_that_occurs_twice_is_written_out_twice():
    values = [1.0, 2.0]
    assert parse_yaml(dump_yaml({'a': values, 'b': values})) == {'a': values, 'b': values}


def test_no_other_module_of_the_product_reads_yaml_or_json():
    """
    `parse_yaml` and `parse_json` refuse what they cannot read in one line.

    The warm parent takes its requests from its own supervisor alone, with environments that
    `parse_json` refuses, as their bytes need not be UTF-8. The processes of compiled code of
    others (`host.py`) take theirs from the program alone, and import nothing of ours.
    """
    from pathlib import Path

    root = Path(yaml_text.__file__).parents[3]
    allowed = {'yaml_text.py', 'json_records.py', 'message_definitions.py', 'forks.py', 'host.py'}
    words = ('import yaml', 'yaml.load', 'safe_load', 'json.load')
    for package in ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup'):
        for file in (root / package / package).rglob('*.py'):
            text = file.read_text(encoding='utf-8')
            assert file.name in allowed or not any(word in text for word in words), file


def test_each_key_and_item_has_the_line_in_which_it_begins():
    content, lines = parse_yaml_with_lines('a:\n  b: 1\n\n  c:\n  - 2\n  - {d: 3,\n     e: 4}\n')
    assert content == {'a': {'b': 1, 'c': [2, {'d': 3, 'e': 4}]}}
    places = ['a', 'a.b', 'a.c', 'a.c[0]', 'a.c[1]', 'a.c[1].e']
    assert [lines[place] for place in places] == [1, 2, 4, 5, 6, 7]
