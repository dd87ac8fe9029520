# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Read and write all YAML: scenarios, controllers, and the texts in a bag.

Values are those of YAML 1.2's core schema (1e-3 and -1e-2 are numbers, yes and 1:30 are text).
They are built here from the parser's events, so text cannot create any other object.
"""

import re
from collections.abc import Iterator
from typing import Any

import yaml

from ddct_plant.base.errors import ParameterError

MOST_DIGITS = 40
"""Most characters of a number; a double needs 24."""

_PARSER = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
_EMITTER = getattr(yaml, 'CSafeDumper', yaml.SafeDumper)
_WORDS = {
    **dict.fromkeys(('', '~', 'null', 'Null', 'NULL')),
    **dict.fromkeys(('true', 'True', 'TRUE'), True),
    **dict.fromkeys(('false', 'False', 'FALSE'), False),
}
_INTEGER = re.compile(r'[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+')
_FLOAT = re.compile(
    r'[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?'
    r'|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)'
)


def parse_yaml(text: str) -> Any:
    """Return the value of one YAML document; errors as in `parse_yaml_with_lines`."""
    return parse_yaml_with_lines(text)[0]


def parse_yaml_with_lines(text: str) -> tuple[Any, dict[str, int]]:
    """
    Return the value of one YAML document, and the line numbers in it.

    The value consists of numbers, texts, booleans, nulls, lists and dicts. The lines are those of
    keys and of items of lists, by their path: `engine.time_s`, `engine.time_s[2]`.

    Raise ParameterError with the line for invalid YAML, a duplicate key, aliases and tags, and
    numbers that are too long.
    """
    try:
        document = _Document(yaml.parse(text, Loader=_PARSER))
        return document.value(), document.lines
    except UnicodeEncodeError as error:  # an argument in another encoding
        raise ParameterError('not valid YAML: it is not UTF-8 text') from error
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1
        raise ParameterError(f'not valid YAML: {error.problem}', place=f'line {line}') from error
    except yaml.YAMLError as error:
        raise ParameterError(f'not valid YAML: {" ".join(str(error).split())}') from error


def dump_yaml(value: Any, **options: Any) -> str:
    """Return YAML text, with keys in their order, that `parse_yaml` reads back to equal values."""
    return yaml.dump(value, Dumper=_Dumper, sort_keys=False, **options)


class _Dumper(_EMITTER):  # type: ignore[misc, valid-type]
    """Dumper that quotes text that YAML 1.2 reads as a number, and writes no aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


_Dumper.add_implicit_resolver(
    'tag:yaml.org,2002:float',
    re.compile(rf'(?:{_FLOAT.pattern}|{_INTEGER.pattern})$'),
    list('-+.0123456789'),
)


class _Document:
    """Builder of the values of one document from the events of the parser."""

    def __init__(self, events: Iterator[yaml.Event]) -> None:
        self._events = events
        self.lines: dict[str, int] = {}
        """Line numbers of keys and items, from 1, by path."""

    def value(self) -> Any:
        """Return the value of the only document; None for empty text."""
        next(self._events)
        event = next(self._events)
        if isinstance(event, yaml.StreamEndEvent):
            return None
        value = self._value(next(self._events), '')
        next(self._events)
        after = next(self._events)
        if not isinstance(after, yaml.StreamEndEvent):
            raise _bad_yaml(after, 'a second document begins: give one')
        return value

    def _value(self, event: yaml.Event, path: str) -> Any:
        if isinstance(event, yaml.AliasEvent):
            raise _bad_yaml(event, f'the alias *{event.anchor}: write out what it stands for')
        if event.tag is not None:
            raise _bad_yaml(event, f'the tag {event.tag}: write the value without it')
        if isinstance(event, yaml.ScalarEvent):
            return _scalar(event)
        if isinstance(event, yaml.SequenceStartEvent):
            return self._sequence(path)
        return self._mapping(path)

    def _sequence(self, path: str) -> list[Any]:
        content: list[Any] = []
        for event in self._until(yaml.SequenceEndEvent):
            item_path = f'{path}[{len(content)}]'
            self.lines[item_path] = _line(event)
            content.append(self._value(event, item_path))
        return content

    def _mapping(self, path: str) -> dict[Any, Any]:
        content: dict[Any, Any] = {}
        lines: dict[Any, int] = {}
        for event in self._until(yaml.MappingEndEvent):
            if not isinstance(event, (yaml.ScalarEvent, yaml.AliasEvent)):
                raise _bad_yaml(event, 'a list or mapping is used as a key: give text')
            key = self._value(event, '')
            if key in lines:
                first = lines[key]
                raise _bad_yaml(event, f'the key {key!r} is given twice, first in line {first}')
            key_path = f'{path}.{key}' if path else str(key)
            lines[key] = self.lines[key_path] = _line(event)
            content[key] = self._value(next(self._events), key_path)
        return content

    def _until(self, end: type[yaml.Event]) -> Iterator[yaml.Event]:
        while not isinstance(event := next(self._events), end):
            yield event


def _scalar(event: yaml.ScalarEvent) -> Any:
    text = event.value
    if not event.implicit[0]:  # in quotes, or a block of text
        return text
    if text in _WORDS:
        return _WORDS[text]
    integer = _INTEGER.fullmatch(text)
    if not integer and not _FLOAT.fullmatch(text):
        return text
    if len(text) > MOST_DIGITS:
        raise _bad_yaml(event, f'a number of {len(text)} digits: give at most {MOST_DIGITS}')
    if integer:
        return int(text, {'0o': 8, '0x': 16}.get(text[:2], 10))
    return float(text.lower().replace('.inf', 'inf').replace('.nan', 'nan'))


def _bad_yaml(event: yaml.Event, what: str) -> ParameterError:
    return ParameterError(f'not valid YAML: {what}', place=f'line {_line(event)}')


def _line(event: yaml.Event) -> int:
    return int(event.start_mark.line) + 1
