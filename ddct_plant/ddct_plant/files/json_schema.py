# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
JSON Schema of a record, from its dataclass: for readers of our JSON in any language.

Keys, their types and which of them may be null are those that `json_records` writes and reads.
What a key means is the docstring of its field.
"""

import ast
import inspect
import re
import textwrap
import typing
from collections.abc import Mapping
from functools import cache
from typing import Any

from ddct_plant.files.json_records import (
    LISTS,
    MAPPINGS,
    UNIONS,
    choices_of,
    fields_of,
    is_record,
    keys_of,
)

_DIALECT = 'https://json-schema.org/draft/2020-12/schema'
_PLAIN = {float: 'number', int: 'integer', bool: 'boolean', str: 'string', type(None): 'null'}
Schema = dict[str, Any]
_NONE: Mapping[str, Any] = {}


def json_schema(kind: Any, title: str, others: Mapping[str, Any] = _NONE) -> Schema:
    """
    Return the schema of a document, draft 2020-12; `kind` is its dataclass, or another type.

    `others` are types by name in place of those of the dataclass: for a key that has any content
    there, and a narrower one in this document. Raise TypeError for a type that JSON cannot have,
    and for two dataclasses of the same name.
    """
    made = _Made()
    content = made.record(kind, others) if is_record(kind) else made.of(kind)
    definitions = {name: made.definitions[name] for name in sorted(made.definitions)}
    return {
        '$schema': _DIALECT,
        'title': title,
        **content,
        **({'$defs': definitions} if definitions else {}),
    }


class _Made:
    """The schemas of the dataclasses in one document."""

    def __init__(self) -> None:
        self.definitions: dict[str, Schema] = {}
        self._kinds: dict[str, Any] = {}

    def record(self, kind: Any, others: Mapping[str, Any]) -> Schema:
        """Return the schema of a dataclass, with other types for some of its keys."""
        meanings = _meanings(kind)
        properties = {}
        for name, hint in {**keys_of(kind), **others}.items():
            about = {'description': meanings[name]} if name in meanings else {}
            properties[name] = self.of(hint) | about
        return {
            'description': _sentence(inspect.getdoc(kind) or ''),
            'type': 'object',
            'properties': properties,
            'required': [*properties],
            'additionalProperties': False,
        }

    def of(self, kind: Any) -> Schema:
        """Return the schema of a type; a dataclass gets a definition."""
        origin, arguments = typing.get_origin(kind), typing.get_args(kind)
        if kind in (Any, object):
            return {}
        if kind in _PLAIN:
            return {'type': _PLAIN[kind]}
        if choices := choices_of(kind):
            return {'const': choices[0]} if len(choices) == 1 else {'enum': [*choices]}
        if origin in UNIONS:
            return _any_of([self.of(each) for each in arguments])
        if origin in LISTS:
            return self._list(origin, arguments)
        if origin in MAPPINGS:
            return self._mapping(*arguments)
        if is_record(kind):
            return self._reference(kind)
        raise TypeError(f'{kind} has no form in JSON')

    def _list(self, origin: Any, arguments: tuple[Any, ...]) -> Schema:
        if origin is tuple and arguments[-1] is not Ellipsis:
            items = [self.of(each) for each in arguments]
            return {'type': 'array', 'prefixItems': items, 'minItems': len(items), 'items': False}
        return {'type': 'array', 'items': self.of(arguments[0])}

    def _mapping(self, key: Any, value: Any) -> Schema:
        names = {} if key is str else {'propertyNames': self.of(key)}
        return {'type': 'object', **names, 'additionalProperties': self.of(value)}

    def _reference(self, kind: Any) -> Schema:
        name = kind.__name__
        known = self._kinds.setdefault(name, kind)
        if known is not kind:
            raise TypeError(f'two dataclasses are called {name}: {known} and {kind}')
        if name not in self.definitions:
            self.definitions[name] = {}  # one that is in itself has a definition already
            self.definitions[name] = self.record(kind, _NONE)
        return {'$ref': f'#/$defs/{name}'}


def _any_of(schemas: list[Schema]) -> Schema:
    """Return the schema of a union; plain types are one list, in which numbers may be whole."""
    if all(each.keys() == {'type'} for each in schemas):
        types = [each['type'] for each in schemas]
        return {'type': [each for each in types if each != 'integer' or 'number' not in types]}
    return {'anyOf': schemas}


@cache
def _meanings(kind: Any) -> dict[str, str]:
    """Return by name the docstrings of the fields of a dataclass, and of those inline."""
    found: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        if is_record(base):
            (tree,) = ast.parse(textwrap.dedent(inspect.getsource(base))).body
            assert isinstance(tree, ast.ClassDef)
            found |= _docstrings(tree)
    for hint, inlined in fields_of(kind).values():
        found |= _meanings(hint) if inlined else {}
    return found


def _docstrings(tree: ast.ClassDef) -> dict[str, str]:
    found: dict[str, str] = {}
    for field, after in zip(tree.body, tree.body[1:], strict=False):
        if (
            isinstance(field, ast.AnnAssign)
            and isinstance(field.target, ast.Name)
            and isinstance(after, ast.Expr)
            and isinstance(after.value, ast.Constant)
        ):
            found[field.target.id] = _sentence(inspect.cleandoc(str(after.value.value)))
    return found


def _sentence(text: str) -> str:
    """Return the first paragraph of a docstring on one line, in the words of JSON."""
    paragraph = ' '.join(text.partition('\n\n')[0].split())
    return re.sub(r'\bNone\b', 'null', paragraph)
