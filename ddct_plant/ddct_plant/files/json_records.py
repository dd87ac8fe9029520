# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Write and read all JSON: results, evidence, manifests, and the texts in a bag.

A dataclass is the record: its fields are the keys, in their order, all of them in every file.
Fields with `init=False` are computed, and are no keys; those that are `Inline` are no keys either:
the keys of the dataclass in them stand in the object itself.

A new document is a frozen dataclass, whose fields have docstrings: `write_json(path, record)`
writes it, `read_json(Kind, path)` reads it, and a line in `ddct_bringup.schemas` gives its schema.
"""

import dataclasses
import enum
import json
import reprlib
import sys
import types
import typing
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import cache, partial
from itertools import repeat
from pathlib import Path
from typing import Annotated, Any, NoReturn, TypeVar

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.options import close_name
from ddct_plant.files.input_file import located, require_schema_version, user_text
from ddct_plant.files.output_file import write_text

T = TypeVar('T')
_INLINE = 'inline'
Inline = Annotated[T, _INLINE]
"""Annotation of a field for another dataclass, whose keys stand among those around it."""
_Reader = Callable[[Any], Any]
"""Converter of plain data to one type; it raises _RecordError."""


def to_json(obj: Any) -> Any:
    """
    Return a record as plain data: dicts with text keys, lists, texts, numbers, booleans, None.

    Also converted are enums, and numpy's scalars and arrays. Raise TypeError for other objects.
    """
    if obj is None or isinstance(obj, (bool, int, float, str)):
        return obj.value if isinstance(obj, enum.Enum) else obj
    kind: Any = type(obj)
    if is_record(kind):
        content: dict[str, Any] = {}
        for name, (_, inlined) in fields_of(kind).items():
            value = to_json(getattr(obj, name))
            content |= value if inlined else {name: value}
        return content
    if isinstance(obj, Mapping):
        if not all(isinstance(key, str) for key in obj):
            raise TypeError(f'keys of JSON are texts, not as in {obj!r}')
        return {key: to_json(value) for key, value in obj.items()}
    if isinstance(obj, (list, tuple)):
        return [to_json(each) for each in obj]
    if isinstance(obj, enum.Enum):
        return obj.value
    if hasattr(obj, 'tolist'):
        return obj.tolist()
    raise TypeError(f'{type(obj).__name__} has no form in JSON')


def json_text(obj: Any) -> str:
    """Return a record as the text of a file; raise ValueError for NaN and infinity."""
    return json.dumps(to_json(obj), indent=2, allow_nan=False) + '\n'


def json_line(obj: Any) -> str:
    """Return a record as one line, as in a bag; raise ValueError for NaN and infinity."""
    return json.dumps(to_json(obj), allow_nan=False)


def write_json(target: str, obj: Any, advice: str = '') -> None:
    """Write a record by `write_text`; raise ValueError for NaN and infinity."""
    write_text(target, json_text(obj), advice)


def parse_json(text: str) -> Any:
    """
    Return the value of JSON text; raise ParameterError with the reason for invalid text.

    Refused beyond the grammar: duplicate keys, NaN and infinity, and integers beyond the limit of
    Python.
    """
    try:
        return json.loads(text, object_pairs_hook=_object, parse_constant=_refuse_constant)
    except ValueError as error:
        raise ParameterError(f'not valid JSON: {error}') from error


def read_json(
    kind: type[T],
    path: Path,
    *,
    newest: int | None = None,
    advice: str = '',
) -> T:
    """
    Return the record of this type in a file.

    Raise DdctError that names the file, for what cannot be read and as `from_json` does, with the
    advice, if any, at its end.
    """
    try:
        return _record_in(kind, path, newest)
    except DdctError as error:
        if not advice:
            raise
        found = DdctError(f'{error}: {advice}', key=error.key)
        found.place = error.place
        raise found from error


def _record_in(kind: type[T], path: Path, newest: int | None) -> T:
    with located(str(path)):
        data = parse_json(user_text(path))
    return from_json(kind, data, path, newest=newest)


def from_json(kind: type[T], data: Any, place: object, *, newest: int | None = None) -> T:
    """
    Return plain data, as `parse_json` gives it, as a record of this type.

    `kind` is a dataclass or another annotation: numbers, texts, booleans, None, literals, enums,
    lists, tuples, sequences (read as tuples), unions, mappings whose keys are texts. A number in
    place of a float stays as it is. `newest` is the newest schema version that is supported.

    Raise ParameterError that names `place` and the path of the key, such as `runs[3].state`: for
    an unknown and a missing key, a wrong type, another schema version, and what the dataclass
    itself refuses.
    """
    if newest is not None and isinstance(data, dict):
        try:
            require_schema_version(data, newest)
        except ParameterError as error:
            raise error.at(place) from None
    annotation: Any = kind
    try:
        record: T = _reader(annotation)(data)
    except _RecordError as error:
        raise ParameterError(error.line(), key=error.path, place=place) from error.__cause__
    return record


class _RecordError(Exception):
    """What is wrong with the data at a path; `{}` in its text stands for the path."""

    def __init__(self, text: str, path: str = '') -> None:
        super().__init__(text)
        self.text = text
        self.path = path

    def under(self, step: str) -> '_RecordError':
        """Return the same one level up, under a key or an index."""
        dot = '.' if self.path and not self.path.startswith('[') else ''
        return _RecordError(self.text, f'{step}{dot}{self.path}')

    def line(self) -> str:
        """Return the text with the path; the first `{}` is ours, others are of the data."""
        text = self.text if self.path else self.text.removeprefix('{}: ')
        return text.replace('{}', self.path or 'it', 1)


def _wrong_type(data: Any, kind: Any) -> _RecordError:
    found = {dict: 'an object', list: 'a list', type(None): 'null'}.get(type(data))
    return _RecordError(f'{{}} is {found or reprlib.repr(data)}: give {_expected(kind)}')


_PLAIN: dict[Any, str] = {
    float: 'a number',
    int: 'a whole number',
    bool: 'true or false',
    str: 'a text',
    type(None): 'null',
}
"""Plain types with their names in an error."""
LISTS = (list, tuple, Sequence)
MAPPINGS = (dict, Mapping)
UNIONS = (typing.Union, types.UnionType)


def _expected(kind: Any) -> str:
    """Return the name of a type in an error."""
    if kind in _PLAIN:
        return _PLAIN[kind]
    if typing.get_origin(kind) in UNIONS:
        return ' or '.join(dict.fromkeys(_expected(each) for each in typing.get_args(kind)))
    choices = choices_of(kind)
    if choices:
        return ' or '.join(json.dumps(each) for each in choices)
    return 'a list' if typing.get_origin(kind) in LISTS else 'an object'


def choices_of(kind: Any) -> tuple[Any, ...]:
    """Return the values of a literal or an enum; empty for another type."""
    if typing.get_origin(kind) is typing.Literal:
        return typing.get_args(kind)
    if isinstance(kind, type) and issubclass(kind, enum.Enum):
        return tuple(each.value for each in kind)
    return ()


@cache
def _reader(kind: Any) -> _Reader:
    """Return the converter to a type; raise TypeError for one that JSON cannot have."""
    if kind in (Any, object):
        return lambda data: data
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if kind in _PLAIN or choices_of(kind):
        return partial(_read_plain, kind)
    if origin in UNIONS:
        return _union_reader(kind)
    if origin in LISTS:
        return _list_reader(kind)
    if origin in MAPPINGS:
        return partial(_read_mapping, kind, *map(_reader, arguments))
    if is_record(kind):
        return partial(_read_record, kind)
    raise TypeError(f'{kind} has no form in JSON')


def _read_plain(kind: Any, data: Any) -> Any:
    choices = choices_of(kind)
    if choices:
        if any(type(data) is type(each) and data == each for each in choices):
            return kind(data) if isinstance(kind, type) else data
    elif kind is float:
        # The comparison is false for infinity too, which a number such as 1e999 is read as.
        if type(data) in (int, float) and abs(data) <= sys.float_info.max:
            return data
    elif type(data) is kind:
        return data
    raise _wrong_type(data, kind)


def _union_reader(kind: Any) -> _Reader:
    """Return the converter to one of several types, of which at most one is a list."""
    kinds = typing.get_args(kind)
    origins = [typing.get_origin(each) for each in kinds]
    lists = [each for each, origin in zip(kinds, origins, strict=True) if origin in LISTS]
    objects = [
        each
        for each, origin in zip(kinds, origins, strict=True)
        if origin in MAPPINGS or is_record(each)
    ]
    values = [each for each in kinds if each not in lists and each not in objects]

    def read(data: Any) -> Any:
        if lists and isinstance(data, list):
            return _reader(lists[0])(data)
        if objects and isinstance(data, dict):
            likest = min(objects, key=lambda each: _differences(each, data))
            return _reader(likest)(data)
        for each in values:
            with suppress(_RecordError):
                return _reader(each)(data)
        raise _wrong_type(data, kind)

    return read


def _differences(kind: Any, data: dict[str, Any]) -> int:
    """Return the number of keys by which an object is no record of this type."""
    if not is_record(kind):
        return 0
    keys = keys_of(kind)
    count = len(keys.keys() ^ data.keys())
    for name in keys.keys() & data.keys():
        try:
            _reader(keys[name])(data[name])
        except _RecordError:
            count += 1
    return count


def _list_reader(kind: Any) -> _Reader:
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin is not tuple or arguments[-1] is Ellipsis:
        each = _reader(arguments[0])
        return partial(_read_list, kind, list if origin is list else tuple, repeat(each))
    readers = [_reader(argument) for argument in arguments]

    def read(data: Any) -> Any:
        if isinstance(data, list) and len(data) != len(readers):
            raise _RecordError(f'{{}} has {len(data)} values: give {len(readers)}')
        return _read_list(kind, tuple, readers, data)

    return read


def _read_list(kind: Any, make: Callable[..., Any], readers: Iterable[_Reader], data: Any) -> Any:
    if not isinstance(data, list):
        raise _wrong_type(data, kind)
    found = []
    for place, (each, read) in enumerate(zip(data, readers, strict=False)):
        try:
            found.append(read(each))
        except _RecordError as error:
            raise error.under(f'[{place}]') from error.__cause__
    return make(found)


def _read_mapping(kind: Any, read_key: _Reader, read_value: _Reader, data: Any) -> Any:
    if not isinstance(data, dict):
        raise _wrong_type(data, kind)
    found = {}
    for key, value in data.items():
        try:
            found[read_key(key)] = read_value(value)
        except _RecordError as error:
            raise error.under(key) from error.__cause__
    return found


def _read_record(kind: Any, data: Any) -> Any:
    if not isinstance(data, dict):
        raise _wrong_type(data, kind)
    keys = keys_of(kind)
    for name in data:
        if name not in keys:
            raise _RecordError(f'unknown key {{}}: {close_name(name, keys)}', name)
    found = {}
    for name, (hint, inlined) in fields_of(kind).items():
        if inlined:
            found[name] = _read_record(
                hint, {key: data[key] for key in keys_of(hint) if key in data}
            )
            continue
        if name not in data:
            raise _RecordError('the key {} is missing', name)
        try:
            found[name] = _reader(hint)(data[name])
        except _RecordError as error:
            raise error.under(name) from error.__cause__
    try:
        return kind(**found)
    except DdctError as error:
        raise _RecordError(f'{{}}: {error}') from error


def is_record(kind: Any) -> bool:
    """Return whether a type is a dataclass."""
    return dataclasses.is_dataclass(kind)


@cache
def fields_of(kind: Any) -> dict[str, tuple[Any, bool]]:
    """Return by name the type of each field that is not computed, and whether it is inline."""
    hints = typing.get_type_hints(kind, include_extras=True)
    plain = typing.get_type_hints(kind)
    return {
        each.name: (plain[each.name], _INLINE in getattr(hints[each.name], '__metadata__', ()))
        for each in dataclasses.fields(kind)
        if each.init
    }


@cache
def keys_of(kind: Any) -> dict[str, Any]:
    """Return the types of the keys of a dataclass."""
    keys: dict[str, Any] = {}
    for name, (hint, inlined) in fields_of(kind).items():
        keys |= keys_of(hint) if inlined else {name: hint}
    return keys


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    value = dict(pairs)
    if len(value) != len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f'the key {twice!r} is given twice')
    return value


def _refuse_constant(constant: str) -> NoReturn:
    raise ValueError(f'{constant} is no number')
