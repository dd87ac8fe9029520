# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Read and write all YAML: scenarios, controllers, and the texts in a bag.

Values are those of YAML 1.2's core schema (1e-3 and -1e-2 are numbers, yes and 1:30 are text).
"""

import re
from collections.abc import Callable
from typing import Any

import yaml

from ddct_plant.base.errors import ParameterError

_TAG = 'tag:yaml.org,2002:'
_INTEGER = r'[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+'
_FLOAT = (
    r'[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?'
    r'|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)'
)
_CORE = {
    'null': (r'~|null|Null|NULL|', ['~', 'n', 'N', '']),
    'bool': (r'true|True|TRUE|false|False|FALSE', list('tTfF')),
    'int': (_INTEGER, list('-+0123456789')),
    'float': (_FLOAT, list('-+.0123456789')),
}
"""Forms of text without quotes that are no text, with their first characters."""


_OTHERS = (f'{_TAG}str', f'{_TAG}seq', f'{_TAG}map', None)
"""Tags of the core schema for values of any form; None stands for every other tag."""
_SYNTAX = 'check quotes, brackets and indentation up to there'
_ADVICE = {
    yaml.scanner.ScannerError: _SYNTAX,
    yaml.parser.ParserError: _SYNTAX,
    yaml.composer.ComposerError: 'give one document, with values in place of aliases',
    yaml.constructor.ConstructorError: 'give texts as keys, and values without tags',
}
"""What to do about an error of the library, by its class."""


class _Loader(getattr(yaml, 'CSafeLoader', yaml.SafeLoader)):  # type: ignore[misc]
    """Loader of the core schema, with an error for a tag of another one."""

    yaml_implicit_resolvers: dict[str, list[tuple[str, re.Pattern[str]]]] = {}
    yaml_constructors = {tag: yaml.SafeLoader.yaml_constructors[tag] for tag in _OTHERS}


def _integer(_: yaml.SafeLoader, node: yaml.ScalarNode) -> int:
    return int(node.value, {'0o': 8, '0x': 16}.get(node.value[:2], 10))


def _of_form(form: re.Pattern[str], make: Callable[..., Any]) -> Callable[..., Any]:
    """Return a constructor that makes a value of text of a form, also where a tag is given."""

    def construct(loader: yaml.SafeLoader, node: yaml.ScalarNode) -> Any:
        if not form.match(loader.construct_scalar(node)):
            raise yaml.MarkedYAMLError(
                problem=f'{node.value!r} has another form than its tag says: leave the tag out',
                problem_mark=node.start_mark,
            )
        return make(loader, node)

    return construct


for _name, (_text, _first) in _CORE.items():
    _form = re.compile(rf'(?:{_text})\Z')
    _make = _integer if _name == 'int' else yaml.SafeLoader.yaml_constructors[_TAG + _name]
    _Loader.add_implicit_resolver(_TAG + _name, _form, _first)
    _Loader.add_constructor(_TAG + _name, _of_form(_form, _make))


class _Dumper(getattr(yaml, 'CSafeDumper', yaml.SafeDumper)):  # type: ignore[misc]
    """Dumper that quotes text that YAML 1.2 reads as a number, and writes no aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


_Dumper.add_implicit_resolver(
    f'{_TAG}float', re.compile(rf'(?:{_FLOAT}|{_INTEGER})\Z'), list('-+.0123456789')
)


def parse_yaml(text: str) -> Any:
    """Return the value of one YAML document; errors as in `parse_yaml_with_lines`."""
    return parse_yaml_with_lines(text)[0]


def parse_yaml_with_lines(text: str) -> tuple[Any, dict[str, int]]:
    """
    Return the value of one YAML document, and the line numbers in it.

    The lines are those of keys and of items of lists, by their path: `engine.time_s`,
    `engine.time_s[2]`. Raise ParameterError with the line for invalid YAML, a key that is given
    twice and an unknown tag.
    """
    lines: dict[str, int] = {}
    try:
        loader = _Loader(text)
        node = loader.get_single_node()
        _note_lines(node, '', lines)
        return node and loader.construct_document(node), lines
    except yaml.MarkedYAMLError as error:
        what = ' '.join(filter(None, (error.context, error.problem)))
        if advice := _ADVICE.get(type(error)):
            what = f'{what}: {advice}'
        place = f'line {_line(error.problem_mark or error.context_mark)}'
        raise ParameterError(f'not valid YAML: {what}', place=place) from error
    except yaml.reader.ReaderError as error:
        above = text.encode(errors='surrogatepass')[: error.position].count(b'\n')
        raise ParameterError(
            'not valid YAML: a control character: delete it', place=f'line {above + 1}'
        ) from error
    except (yaml.YAMLError, ValueError) as error:
        raise ParameterError(f'not valid YAML: {" ".join(str(error).split())}') from error


def dump_yaml(value: Any, **options: Any) -> str:
    """Return YAML text, with keys in their order, that `parse_yaml` reads back to equal values."""
    return yaml.dump(value, Dumper=_Dumper, sort_keys=False, **options)


def _note_lines(
    node: yaml.Node | None, path: str, lines: dict[str, int], above: tuple[yaml.Node, ...] = ()
) -> None:
    """
    Note the lines of keys and items below a node, which has the nodes `above` around it.

    Raise MarkedYAMLError for a key that is given twice, and for an alias of what is around it.
    """
    if node and node in above:
        raise yaml.MarkedYAMLError(
            problem='an alias stands in what it stands for: write it out',
            problem_mark=node.start_mark,
        )
    if isinstance(node, yaml.SequenceNode):
        for index, item in enumerate(node.value):
            lines[f'{path}[{index}]'] = _line(item.start_mark)
            _note_lines(item, f'{path}[{index}]', lines, (*above, node))
    elif isinstance(node, yaml.MappingNode):
        keys: set[str] = set()
        for key, value in node.value:
            key_path = f'{path}.{key.value}' if path else str(key.value)
            if key_path in keys:
                raise yaml.MarkedYAMLError(
                    problem=f'the key {key.value!r} is given twice, first in line '
                    f'{lines[key_path]}: keep one',
                    problem_mark=key.start_mark,
                )
            keys.add(key_path)
            lines[key_path] = _line(key.start_mark)
            _note_lines(value, key_path, lines, (*above, node))


def _line(mark: yaml.Mark) -> int:
    return int(mark.line) + 1
