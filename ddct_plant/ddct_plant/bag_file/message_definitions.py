# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Message definitions without ROS: schema text, type hash and fields of each type on the graph."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import read_text_file
from ddct_plant.files.yaml_text import parse_yaml

TYPES_FILE = Path(__file__).with_name('messages.yaml')

STRING = 'string'
PRIMITIVES = {
    **{'bool': (1, '?'), 'byte': (1, 'B'), 'char': (1, 'b')},
    **{'int8': (1, 'b'), 'uint8': (1, 'B'), 'int16': (2, 'h'), 'uint16': (2, 'H')},
    **{'int32': (4, 'i'), 'uint32': (4, 'I'), 'int64': (8, 'q'), 'uint64': (8, 'Q')},
    **{'float32': (4, 'f'), 'float64': (8, 'd')},
}
"""Size in bytes of each primitive type, and its letter for the module `struct`, by name."""

_SEPARATOR = '=' * 80
_FIELD = re.compile(
    r'(?P<kind>[\w/]+)(?:<=\d+)?(?P<many>\[(?:<=\d+|(?P<count>\d*))\])? (?P<name>\w+)'
)
"""Pattern of a line of a definition that declares a field; constants do not match."""


@dataclass(frozen=True)
class Field:
    """One field of a message type."""

    kind: str
    """Type of its values: one of PRIMITIVES, STRING, or a type such as 'std_msgs/msg/Header'."""
    count: int | None
    """Number of its values; None where it differs from message to message."""
    name: str
    many: bool
    """Whether it is a list."""


@dataclass(frozen=True)
class MessageDefinition:
    """Definition of a message type as a bag stores it."""

    type_name: str
    """Name of the type, such as 'std_msgs/msg/Header'."""
    schema_text: str
    """Definition of the type, then that of each nested type, once, depth first."""
    type_hash: str
    """RIHS01 hash of the type."""
    fields: Mapping[str, list[Field]]
    """Fields of the type and of each nested type, by type name."""


@cache
def load_definition(type_name: str) -> MessageDefinition:
    """Return the definition of a type on the graph, such as 'std_msgs/msg/Header'."""
    return definition_in(message_types(), type_name)


@cache
def message_types() -> Mapping[str, Any]:
    """Return the content of TYPES_FILE: hash and fields as text, by type name."""
    return parse_yaml(read_text_file(TYPES_FILE))


def definition_in(types: Mapping[str, Any], type_name: str) -> MessageDefinition:
    """
    Return the definition of a type from a mapping as `message_types` returns it.

    Raise DdctError where the type, or a nested one, is not in it.
    """
    fields: dict[str, list[Field]] = {}
    text: list[str] = []

    def visit(name: str) -> None:
        if name in fields:
            return
        if name not in types:
            raise DdctError(f'{TYPES_FILE.name} does not define {name}: add it there', key=name)
        lines = types[name]['fields']
        if text:
            text.extend(('', _SEPARATOR, f'MSG: {name.replace("/msg/", "/")}'))
        text.extend(lines)
        fields[name] = [_field(line) for line in lines if '=' not in line.replace('<=', '')]
        for field in fields[name]:
            if field.kind not in PRIMITIVES and field.kind != STRING:
                visit(field.kind)

    visit(type_name)
    schema_text = '\n'.join((*text, ''))
    return MessageDefinition(type_name, schema_text, types[type_name]['hash'], fields)


def _field(line: str) -> Field:
    found = _FIELD.fullmatch(line)
    if found is None:
        raise DdctError(f'{TYPES_FILE.name}: {line!r} is no field')
    kind = found['kind'].replace('/', '/msg/')
    if not found['many']:
        return Field(kind, 1, found['name'], many=False)
    count = int(found['count']) if found['count'] else None
    return Field(kind, count, found['name'], many=True)
