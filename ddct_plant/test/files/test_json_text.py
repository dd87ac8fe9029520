# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""JSON from files and bags is read in one way, or refused in one line."""

import pytest

from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import parse_json


def test_values_come_back():
    text = '{"a": [1, 2.5, true, null], "b": {"c": "\\ud83d\\ude97 \\u00e4"}}'
    assert parse_json(text) == {'a': [1, 2.5, True, None], 'b': {'c': '\U0001f697 ä'}}


@pytest.mark.parametrize(
    ('text', 'complaint'),
    [
        ('', 'not valid JSON'),
        ('{"a": 1, "a": 2}', "the key 'a' is given twice"),
        ('{"b": {"a": 1, "a": 2}}', "the key 'a' is given twice"),
        ('9' * 5000, 'not valid JSON'),
        ('[NaN]', 'NaN is no number'),
        ('-Infinity', '-Infinity is no number'),
    ],
)
def test_what_is_no_valid_json_is_refused_in_one_line(text, complaint):
    with pytest.raises(DdctError) as caught:
        parse_json(text)
    assert complaint in str(caught.value)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 300
