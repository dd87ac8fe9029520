# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The message types of ROS 2 Jazzy without ROS: definitions, hashes, messages and their bytes.

rosbags has them all; nothing else in the project knows how a message type is defined. Those of our
topics are in a file too: to load all those of rosbags takes 40 ms of processor time in each
process that does it, which is 2 % of a run of the graph.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import read_json

KEPT = Path(__file__).with_name('message_definitions.json')
"""Definitions of the types of our topics, by type; `tools/run definitions` writes it."""
STRING = 'string'
PRIMITIVES = {
    **{'bool': (1, '?'), 'byte': (1, 'B'), 'char': (1, 'b')},
    **{'int8': (1, 'b'), 'uint8': (1, 'B'), 'int16': (2, 'h'), 'uint16': (2, 'H')},
    **{'int32': (4, 'i'), 'uint32': (4, 'I'), 'int64': (8, 'q'), 'uint64': (8, 'Q')},
    **{'float32': (4, 'f'), 'float64': (8, 'd')},
}
"""Size in bytes of each primitive type, and its letter for the module `struct`, by name."""


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
def all_types() -> Any:
    """Return the type store of rosbags with all types of ROS 2 Jazzy."""
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY)


@cache
def _our_types() -> Any:
    """Return a type store of rosbags with the types of our topics alone."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.EMPTY)
    parsed = [get_types_from_msg(each.schema_text, name) for name, each in _kept().items()]
    store.register({name: fields for types in parsed for name, fields in types.items()})
    return store


def _store_with(type_name: str) -> Any:
    return _our_types() if type_name in _our_types().fielddefs else all_types()


@cache
def _kept() -> Mapping[str, MessageDefinition]:
    kind: Any = Mapping[str, MessageDefinition]
    kept: Mapping[str, MessageDefinition] = read_json(kind, KEPT)
    return kept


@cache
def load_definition(type_name: str) -> MessageDefinition:
    """Return the definition of a type; raise DdctError for one that ROS 2 Jazzy does not have."""
    return _kept().get(type_name) or definition_in(_store_with(type_name), type_name)


def definition_in(store: Any, type_name: str) -> MessageDefinition:
    """Return the definition of a type in a type store of rosbags; DdctError if it has none."""
    if type_name not in store.fielddefs:
        raise DdctError(f'ROS 2 Jazzy has no message type {type_name}', key=type_name)
    fields: dict[str, list[Field]] = {}

    def visit(name: str) -> None:
        if name not in fields:
            fields[name] = [_field(*each) for each in store.fielddefs[name][1]]
            for field in fields[name]:
                if field.kind not in PRIMITIVES and field.kind != STRING:
                    visit(field.kind)

    visit(type_name)
    text, _ = store.generate_msgdef(type_name, ros_version=2)
    # rosbag2 has an empty line before each nested type.
    text = text.replace('\n====', '\n\n====')
    return MessageDefinition(type_name, text, store.hash_rihs01(type_name), fields)


def same_definition(type_name: str, schema_text: str) -> bool:
    """
    Return whether a text defines a type as ROS 2 Jazzy does; comments do not count.

    Raise DdctError for a text that is no definition.
    """
    if schema_text == load_definition(type_name).schema_text:
        return True
    from rosbags.typesys import TypesysError, get_types_from_msg

    try:
        found = get_types_from_msg(schema_text, type_name)
    except TypesysError as error:
        what = ' '.join(str(error).split())
        raise DdctError(f'unusable message definition ({what})') from error
    ours = _store_with(type_name).fielddefs
    return all(found[name][1] == ours.get(name, ((), ()))[1] for name in found)


@cache
def message_class(type_name: str) -> Callable[..., Any]:
    """
    Return a constructor of messages of a type, called as its ROS class: `new(field=value)`.

    Its lists of numbers are arrays.
    """
    store = _store_with(type_name)
    made = store.types[type_name]
    constants, fields = store.fielddefs[type_name]
    kinds = [_field(*each) for each in fields]

    def new(**values: Any) -> Any:
        return made(
            **{
                kind.name: _as_array(kind, values[kind.name])
                if kind.name in values
                else _default(kind)
                for kind in kinds
            }
        )

    for name, _, value in constants:
        setattr(new, name, value)
    return new


def encode(message: Any) -> bytes:
    """Return a message of a `message_class` as CDR, in which bytes for alignment are zero."""
    _make_arrays(message)
    return bytes(_store_with(message.__msgtype__).serialize_cdr(message, message.__msgtype__))


def decode(cdr: bytes, type_name: str) -> Any:
    """Return the message in CDR, with arrays of numbers; raise an error of rosbags for others."""
    return _store_with(type_name).deserialize_cdr(cdr, type_name)


def _default(field: Field) -> Any:
    if field.many:
        return _as_array(field, [])
    if field.kind in PRIMITIVES:
        return 0
    return '' if field.kind == STRING else message_class(field.kind)()


def _as_array(field: Field, value: Any) -> Any:
    """Return an array in place of a list of numbers, which rosbags needs."""
    if not field.many or field.kind not in PRIMITIVES:
        return value
    return np.asarray(value, dtype=PRIMITIVES[field.kind][1])


def _make_arrays(message: Any) -> None:
    """Make arrays of lists of numbers in a message that were set after it was made."""
    for field in load_definition(message.__msgtype__).fields[message.__msgtype__]:
        if field.kind == STRING or (field.kind in PRIMITIVES and not field.many):
            continue
        value = getattr(message, field.name)
        if field.kind in PRIMITIVES:
            setattr(message, field.name, _as_array(field, value))
        else:
            for each in value if field.many else [value]:
                _make_arrays(each)


def _field(name: str, description: Any) -> Field:
    """Return a field from its description in rosbags: a pair of the kind of node and details."""
    from rosbags.interfaces import Nodetype

    node, detail = description
    if node not in (Nodetype.ARRAY, Nodetype.SEQUENCE):
        return Field(detail[0] if node == Nodetype.BASE else detail, 1, name, many=False)
    (node_of_one, of_one), size = detail
    kind = of_one[0] if node_of_one == Nodetype.BASE else of_one
    return Field(kind, size if node == Nodetype.ARRAY else None, name, many=True)
