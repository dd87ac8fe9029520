# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""YAML becomes plain values as YAML 1.2 has them, or is refused with its line, at once."""

import math
import subprocess
import sys
import time

import pytest
import yaml

from ddct_plant.base.errors import DdctError
from ddct_plant.files import yaml_text
from ddct_plant.files.yaml_text import MOST_DEPTH, dump_yaml, parse_yaml, parse_yaml_with_lines

MOST_VALUES = 1000
"""Limit of values in the tests, below the real one, for which the Python parser takes 5 s."""
BOMB = 'a: &a [x]\n' + ''.join(
    f'{new}: &{new} [{", ".join([f"*{old}"] * 10)}]\n'
    for old, new in zip('abcdefgh', 'bcdefghi', strict=True)
)
AT_ONCE_S = 10.0
"""Bound of the processor time in s on slow machines; a refusal takes a thousandth of it."""


@pytest.fixture(params=['C', 'Python'])
def parser(request, monkeypatch):
    """Try both parsers: PyYAML may come without the one in C."""
    name = {'C': 'CSafeLoader', 'Python': 'SafeLoader'}[request.param]
    monkeypatch.setattr(yaml_text, '_PARSER', getattr(yaml, name))
    monkeypatch.setattr(yaml_text, 'MOST_VALUES', MOST_VALUES)


@pytest.mark.usefixtures('parser')
@pytest.mark.parametrize(
    ('text', 'value'),
    [
        ('', None),
        ('a:', {'a': None}),
        ('[1, -2, +3, 0x10, 0o17, 010]', [1, -2, 3, 16, 15, 10]),
        ('[1e-3, -1e-2, .5, 1., +1.5E+2]', [1e-3, -1e-2, 0.5, 1.0, 150.0]),
        ('[.inf, -.INF]', [math.inf, -math.inf]),
        ('[true, False, null, ~]', [True, False, None, None]),
        (
            '[yes, "on", 1:30, 1_000, 2024-01-01, "1"]',
            ['yes', 'on', '1:30', '1_000', '2024-01-01', '1'],
        ),
        ('{a: {b: [c]}, <<: d}', {'a': {'b': ['c']}, '<<': 'd'}),
        ('|\n 12\n', '12\n'),
        ('"\\e[31m \\u00e4"', '\x1b[31m ä'),
        ('[' * MOST_DEPTH + ']' * MOST_DEPTH, eval('[' * MOST_DEPTH + ']' * MOST_DEPTH)),
    ],
)
def test_the_values_are_those_of_yaml_1_2(text, value):
    assert parse_yaml(text) == value


def test_nan_is_a_number():
    assert math.isnan(parse_yaml('.nan'))


@pytest.mark.usefixtures('parser')
@pytest.mark.parametrize(
    ('text', 'line', 'complaint'),
    [
        ('a: 1\nb: 2\na: 3', 3, "the key 'a' is given twice, first in line 1"),
        ('a: {b: 1,\n b: 2}', 2, "the key 'b' is given twice, first in line 1"),
        ('a: 1\n"a": 2', 2, "the key 'a' is given twice"),
        ('[' * 2000, 1, f'nested more than {MOST_DEPTH} deep'),
        ('{a: ' * 2000, 1, f'nested more than {MOST_DEPTH} deep'),
        ('[' * (MOST_DEPTH + 1) + ']' * (MOST_DEPTH + 1), 1, 'nested more than'),
        ('a: ' + '9' * 5000, 1, 'a number of 5000 digits'),
        ('a: 0.' + '9' * 5000, 1, 'a number of 5002 digits'),
        (r'a: "\uD800"', 1, ''),
        ('a: \udcff', 0, 'not UTF-8'),
        (BOMB, 2, 'the alias *a: write out'),
        ('a: ' + 'x' * 10_000_000, 0, 'longer than 1000000 characters'),
        ('[' + '1,' * MOST_VALUES + ']', 1, f'more than {MOST_VALUES} values'),
        ('a: !!python/object/apply:os.getcwd []', 1, 'the tag tag:yaml.org,2002:python/'),
        ('a: !!python/name:os.getcwd', 1, 'the tag'),
        ('!mine 1', 1, 'the tag !mine'),
        ('a: 1\n---\nb: 2', 2, 'a second document'),
        ('[1]: 2', 1, 'a list or mapping is used as a key'),
        ('a: [}', 1, ''),
        ('a: \x1b[31m', 0, 'control characters|special characters'),
    ],
)
def test_what_could_do_harm_is_refused_at_once_in_one_line(text, line, complaint):
    started = time.process_time()
    with pytest.raises(DdctError) as caught:
        parse_yaml(text)
    assert time.process_time() - started < AT_ONCE_S
    message = str(caught.value)
    assert caught.value.place == (f'line {line}' if line else '')
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
    `parse_yaml` and `parse_json` bound what they read.

    The warm parent takes its requests from its own supervisor alone, with environments that
    `parse_json` refuses, as their bytes need not be UTF-8. The processes of compiled code of
    others (`host.py`) take theirs from the program alone, and import nothing of ours.
    """
    from pathlib import Path

    root = Path(yaml_text.__file__).parents[3]
    allowed = {'yaml_text.py', 'input_file.py', 'message_definitions.py', 'forks.py', 'host.py'}
    words = ('import yaml', 'yaml.load', 'safe_load', 'json.load')
    for package in ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup'):
        for file in (root / package / package).rglob('*.py'):
            text = file.read_text(encoding='utf-8')
            assert file.name in allowed or not any(word in text for word in words), file


@pytest.mark.process
def test_refusing_needs_less_than_a_gigabyte():
    program = (
        'import resource, sys\n'
        'from ddct_plant.files.yaml_text import parse_yaml\n'
        'from ddct_plant.base.errors import DdctError\n'
        'resource.setrlimit(resource.RLIMIT_AS, (2**30, 2**30))\n'
        'for text in (sys.stdin.read(), "[" * 900_000):\n'
        '    try: parse_yaml(text)\n'
        '    except DdctError: pass\n'
        '    else: sys.exit("taken")\n'
    )
    done = subprocess.run(
        [sys.executable, '-c', program],
        input=BOMB,
        capture_output=True,
        text=True,
        check=False,
        env={'PYTHONPATH': ':'.join(filter(None, sys.path)), 'OPENBLAS_NUM_THREADS': '1'},
    )
    assert done.returncode == 0, done.stderr


def test_each_key_and_item_has_the_line_in_which_it_begins():
    content, lines = parse_yaml_with_lines('a:\n  b: 1\n\n  c:\n  - 2\n  - {d: 3,\n     e: 4}\n')
    assert content == {'a': {'b': 1, 'c': [2, {'d': 3, 'e': 4}]}}
    places = ['a', 'a.b', 'a.c', 'a.c[0]', 'a.c[1]', 'a.c[1].e']
    assert [lines[place] for place in places] == [1, 2, 4, 5, 6, 7]
