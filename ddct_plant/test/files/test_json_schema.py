# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The schema of a dataclass allows what it is written as, and nothing else."""

import copy
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import pytest
from extras import needs

from ddct_plant.base.errors import ParameterError
from ddct_plant.files.json_records import Inline, from_json, to_json
from ddct_plant.files.json_schema import json_schema

pytestmark = needs('jsonschema')


@dataclass(frozen=True)
class Place:
    """
    Place in a chart.

    Further words.
    """

    x_m: float
    """Distance in m; None
    where it is not known."""
    unit: Literal['m', 'ft']


@dataclass(frozen=True)
class Leaf:
    """End of a tree."""

    value: int | None


@dataclass(frozen=True)
class Tree:
    """Tree whose branches are trees."""

    place: Inline[Place]
    branches: list['Tree | Leaf']
    pair: tuple[str, float]
    by_name: Mapping[Literal['a', 'b'], float | int | None]
    content: Any


TREE = Tree(Place(1, 'm'), [Leaf(None), Leaf(3)], ('a', 0.5), {'a': None, 'b': 2}, {'any': [1]})
SCHEMA = json_schema(Tree, 'a tree', {'content': Mapping[str, list[int]]})


def faults(document: Any) -> list[str]:
    """Return the places at which a document is not as the schema."""
    import jsonschema

    found = jsonschema.Draft202012Validator(SCHEMA).iter_errors(document)
    return sorted(each.json_path for each in found)


def test_a_schema_is_valid_and_allows_what_is_written() -> None:
    import jsonschema

    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    document = to_json(TREE)
    assert faults(document) == []
    document['branches'].append(copy.deepcopy(document))
    assert faults(document) == []
    assert len(from_json(Tree, document, 'it').branches) == 3


@pytest.mark.parametrize(
    ('path', 'value'),
    [
        ('x_m', None),
        ('x_m', True),
        ('unit', 'km'),
        ('branches', {}),
        ('branches', [{'value': 0.5}]),
        ('pair', ['a']),
        ('pair', ['a', 1.0, 2.0]),
        ('by_name', {'c': 1.0}),
        ('by_name', {'a': 'b'}),
        ('place', 1),
    ],
)
def test_a_schema_allows_no_more_than_the_reader(path: str, value: Any) -> None:
    document = {**to_json(TREE), path: value}
    assert faults(document)
    with pytest.raises(ParameterError):
        from_json(Tree, document, 'it')


def test_a_key_of_any_content_is_as_narrow_as_the_document_says() -> None:
    assert faults({**to_json(TREE), 'content': {'any': ['1']}}) == ['$.content.any[0]']


def test_descriptions_are_docstrings_with_the_null_of_json() -> None:
    assert SCHEMA['description'] == 'Tree whose branches are trees.'
    place = SCHEMA['properties']['x_m']
    assert place['description'] == 'Distance in m; null where it is not known.'
    assert 'description' not in SCHEMA['properties']['unit']


def test_two_dataclasses_of_one_name_are_refused() -> None:
    @dataclass
    class Both:
        """Two of one name."""

        one: Leaf
        two: another_leaf()  # type: ignore[valid-type]

    with pytest.raises(TypeError, match='two dataclasses are called Leaf'):
        json_schema(Both, 'both')


def another_leaf() -> Any:
    """Return a dataclass called as another one."""

    @dataclass
    class Leaf:
        """Another one."""

    return Leaf
