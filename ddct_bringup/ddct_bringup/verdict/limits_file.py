"""Read a limits file; whatever is wrong with it is named with file, line and key."""

import argparse
import dataclasses
import hashlib
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from ddct_bringup.verdict.criteria import CRITERION_UNITS
from ddct_bringup.verdict.limits import Limit, Limits, Rules
from ddct_plant.base.errors import DdctError, ParameterError, require_number
from ddct_plant.files.input_file import read_text_file
from ddct_plant.files.schema_version import require_schema_version
from ddct_plant.files.yaml_text import parse_yaml_with_lines

SCHEMA_VERSION = 1
"""Of a limits file."""
PACKAGED = 'packaged'
"""What the limits that come with the package are called."""
_RULE_KEYS = ('value', 'unit', 'reason')
_LIMIT_KEYS = ('criterion', 'value', 'unit', 'applies_to')
_CITATION = ('source', 'clause')


@cache
def packaged_limits() -> Limits:
    """Return the limits that come with the package."""
    file = files('ddct_bringup.verdict') / 'limits.yaml'
    return limits_of_text(file.read_text(encoding='utf-8'), PACKAGED)


def add_limits_option(parser: argparse.ArgumentParser) -> None:
    """Add --limits to a program's options; `load_limits` takes it."""
    parser.add_argument(
        '--limits',
        type=Path,
        metavar='FILE',
        help='limits to judge runs by, see docs/use/verdict.md; default: the packaged ones',
    )


def load_limits(file: str | Path | None) -> Limits:
    """Return the limits of a file, the packaged ones for None; raise DdctError that names it."""
    if file is None:
        return packaged_limits()
    path = Path(file)
    try:
        text = read_text_file(path)
    except OSError as error:
        raise DdctError(f'limits {path}: cannot be read ({error.strerror})') from error
    return limits_of_text(text, str(path))


def limits_of_text(text: str, name: str) -> Limits:
    """
    Return the limits of a text, called `name`; raise ParameterError that names what is bad.

    Their origin has the name without its folders, and a digest that tells two files of one name
    apart.
    """
    try:
        content, lines = parse_yaml_with_lines(text)
        limits = _LimitsFile(lines).limits(content)
    except ParameterError as error:
        raise ParameterError(f'limits {name}: {error}') from error
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    origin = {'name': Path(name).name, 'digest': digest, 'schema_version': SCHEMA_VERSION}
    return dataclasses.replace(limits, origin=origin)


class _LimitsFile:
    """Turns the content of one file into limits, and tells lines by paths."""

    def __init__(self, lines: Mapping[str, int]) -> None:
        self._lines = lines

    def limits(self, content: Any) -> Limits:
        top = self._mapping(content, (), ('rules', 'limits'), ('schema_version',))
        try:
            require_schema_version(top, SCHEMA_VERSION)
        except ParameterError as error:
            raise self._bad(('schema_version',), str(error)) from error
        if not isinstance(top['limits'], list):
            raise self._bad(('limits',), 'give a list of limits')
        return Limits(
            self._rules(top['rules']),
            tuple(self._limit(item, ('limits', i)) for i, item in enumerate(top['limits'])),
        )

    def _rules(self, content: Any) -> Rules:
        fields = dataclasses.fields(Rules)
        rules = self._mapping(content, ('rules',), [field.name for field in fields])
        return Rules(**{field.name: self._rule(rules[field.name], field) for field in fields})

    def _rule(self, content: Any, field: dataclasses.Field[float]) -> float:
        path = ('rules', field.name)
        rule = self._mapping(content, path, _RULE_KEYS)
        self._text(rule['reason'], (*path, 'reason'))
        self._unit(rule['unit'], field.metadata['unit'], (*path, 'unit'))
        least = field.metadata['at_least']
        return self._number(rule['value'], (*path, 'value'), above=0.0, at_least=least)

    def _limit(self, content: Any, path: tuple[Any, ...]) -> Limit:
        limit = self._mapping(content, path, _LIMIT_KEYS, (*_CITATION, 'convention'))
        criterion = limit['criterion']
        if criterion not in CRITERION_UNITS:
            known = ', '.join(CRITERION_UNITS)
            raise self._bad((*path, 'criterion'), f'{criterion!r} is unknown: choose from {known}')
        self._unit(limit['unit'], CRITERION_UNITS[criterion], (*path, 'unit'))
        return Limit(
            criterion,
            self._number(limit['value'], (*path, 'value'), at_least=0.0),
            limit['unit'],
            self._scenarios(limit['applies_to'], (*path, 'applies_to')),
            self._source(limit, path),
        )

    def _source(self, limit: Mapping[str, Any], path: tuple[Any, ...]) -> str:
        if limit.get('convention') is True:
            return 'convention'
        if limit.get('convention', False) is not False:
            raise self._bad((*path, 'convention'), 'give true or false')
        for key in _CITATION:
            if key not in limit:
                raise self._bad(path, f'{key} is missing: cite it, or add `convention: true`')
            self._text(limit[key], (*path, key))
        return f'{limit["source"]}, {limit["clause"]}'

    def _scenarios(self, value: Any, path: tuple[Any, ...]) -> tuple[str, ...] | None:
        if value == 'all':
            return None
        names = isinstance(value, list) and value
        if not names or not all(isinstance(name, str) for name in value):
            raise self._bad(path, "give 'all' or a list of scenarios")
        return tuple(value)

    def _mapping(
        self,
        content: Any,
        path: tuple[Any, ...],
        required: Sequence[str],
        optional: Sequence[str] = (),
    ) -> dict[str, Any]:
        if not isinstance(content, dict):
            raise self._bad(path, 'give keys and values')
        known = (*required, *optional)
        for key in content:
            if key not in known:
                raise self._bad((*path, key), f'unknown key: known are {", ".join(known)}')
        for key in required:
            if key not in content:
                raise self._bad(path, f'the key {key} is missing')
        return content

    def _number(
        self,
        value: Any,
        path: tuple[Any, ...],
        above: float | None = None,
        at_least: float | None = None,
    ) -> float:
        try:
            return require_number('it', value, above=above, at_least=at_least, at_most=1e9)
        except ParameterError as error:
            raise self._bad(path, str(error)) from error

    def _unit(self, value: Any, unit: str, path: tuple[Any, ...]) -> None:
        if value != unit:
            raise self._bad(path, f'it is {value!r}: give the value in {unit!r}')

    def _text(self, value: Any, path: tuple[Any, ...]) -> None:
        if not isinstance(value, str) or not value.strip():
            raise self._bad(path, f'it is {value!r}: give text')

    def _bad(self, path: tuple[Any, ...], what: str) -> ParameterError:
        parts = (f'[{part}]' if isinstance(part, int) else f'.{part}' for part in path)
        key = ''.join(parts).removeprefix('.')
        return ParameterError(f'line {self._lines.get(key, 1)}: {f"{key}: " if key else ""}{what}')
