# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Every command in a message, an example or a page of ours names a program and options that exist.

Those with the values of a run are run too: that of a design in tests/nightly, those of a new
controller in tests/conformance, those on pages of a tuning, campaign and benchmark in
ddct_bringup/test.
"""

import argparse
import ast
import re
import shlex
from collections.abc import Iterator, Sequence
from functools import cache
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any
from unittest import mock

import pytest

from ddct_bringup.programs.node import node_names
from ddct_plant.program.command_line import programs

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
TEXTS = ('.j2', '.js', '.yaml', '.in', '.css')
FILLED_IN = '1'
"""Word in the place of a value that a program fills in: a path, a name and a number."""
_VALUE = re.compile(r'[A-Z]|INDEX|CASE')
"""Words of ours in the place of a whole number."""
_WHOLE = (
    re.compile(r'`(ddct [^`]*)`'),
    re.compile(r'<code>(ddct [^<]*)</code>'),
    re.compile(r'^ +(ddct (?:\\\n +|\S| (?! ))*)', re.MULTILINE),
)
"""Whole commands: in marks, on a page, and on lines of their own, up to two spaces."""
_PART = re.compile(r'\bddct [a-z][a-z-]*(?: --[a-z-]+)*')
"""A program with options of it, in a sentence."""
_NAMED = re.compile(r'ddct [a-z][a-z-]*(?: (?:--)?[a-z-]+)*')
"""A program that is named alone, or with a subcommand and options without their values."""
_WORTH_PARSING = re.compile(r'\bddct\b|\bmake ')
_MAKE = re.compile(r'(?:run |`)make ([a-z-]+)')


class ParsedError(Exception):
    """The end of a program once its arguments are parsed; it has the parser."""


def texts_of(source: Path) -> Iterator[str]:
    """Yield the texts of a file, with a word in the place of each value that is filled in."""
    content = source.read_text(encoding='utf-8')
    if not _WORTH_PARSING.search(content):
        return
    if source.suffix != '.py':
        yield re.sub(r'\{\{.*?\}\}|\$\w+', FILLED_IN, content)
        return
    tree = ast.parse(content)
    inner = {id(part) for node in ast.walk(tree) for part in parts_of(node)}
    for node in ast.walk(tree):
        if id(node) not in inner and (text := text_of(node)):
            yield text


def parts_of(node: ast.AST) -> Sequence[ast.AST]:
    """Return the parts of a formatted text, or of a list of words that begins with `ddct`."""
    if isinstance(node, ast.JoinedStr):
        return node.values
    if isinstance(node, ast.List | ast.Tuple) and node.elts and text_of(node.elts[0]) == 'ddct':
        return node.elts
    return ()


def text_of(node: ast.AST) -> str:
    """Return the text that a part of a program makes; empty where it makes none."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ''
    parts = parts_of(node)
    words = [
        text_of(part) if isinstance(part, ast.Constant | ast.JoinedStr) else FILLED_IN
        for part in parts
    ]
    return ''.join(words) if isinstance(node, ast.JoinedStr) else ' '.join(words)


def found_in(text: str) -> Iterator[tuple[str, bool]]:
    """Yield the commands in a text, and whether each is whole: it has its values."""
    for form in _WHOLE:
        for found in form.findall(text):
            yield found.partition(' | ')[0].replace('\\\n', ' '), not _NAMED.fullmatch(found)
        text = form.sub('', text)
    yield from ((found, False) for found in _PART.findall(text))


@cache
def texts() -> list[tuple[str, str]]:
    """Return the path of a source and a text in it, for all texts in all packages."""
    files = (file for name in PACKAGES for file in (ROOT / name / name).rglob('*'))
    return [
        (str(file.relative_to(ROOT)), text)
        for file in sorted(files)
        if file.suffix in ('.py', *TEXTS)
        for text in texts_of(file)
    ]


@cache
def known_programs() -> dict[str, EntryPoint]:
    """Return the programs by name; to find them takes a while."""
    return programs()


def why_wrong(command: str, *, whole: bool) -> str:
    """Return what is wrong with a command, empty where its program takes it."""
    words = shlex.split(command, comments=True)
    words = [FILLED_IN if _VALUE.fullmatch(word) else word for word in words]
    if len(words) < 2 or words[1] not in known_programs():
        return '' if words[1:] in ([], ['PROGRAM']) else 'no such program'
    if words[1] == 'node':  # the arguments are those of ROS
        return '' if {*words[2:3]} <= {FILLED_IN, *node_names()} else 'no such node'
    main, parser = known_programs()[words[1]].load(), argparse.ArgumentParser
    real: dict[str, Any] = {
        'parse_args': parser.parse_args,
        'parse_known_args': parser.parse_known_args,
    }

    def parsed(self: Any, arguments: Any = None, namespace: Any = None) -> None:
        if whole:
            with mock.patch.multiple(parser, **real):
                self.parse_args(arguments, namespace)
        raise ParsedError(self)

    try:
        with mock.patch.multiple(parser, parse_args=parsed, parse_known_args=parsed):
            main(words[2:])
    except ParsedError as end:
        known = [option for each in parsers_in(end.args[0]) for option in option_names(each)]
        unknown = [word for word in words[2:] if word.startswith('--') and word not in known]
        return f'it does not take {unknown[0]}' if unknown and not whole else ''
    except SystemExit as end:
        return '' if not end.code else 'its parser refuses it'
    return 'it does not parse its arguments'


def parsers_in(parser: argparse.ArgumentParser) -> Iterator[argparse.ArgumentParser]:
    """Yield a parser and those of its subcommands."""
    yield parser
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for each in action.choices.values():
                yield from parsers_in(each)


def option_names(parser: argparse.ArgumentParser) -> Sequence[str]:
    return list(parser._option_string_actions)


def test_every_command_in_the_sources_is_one_that_its_program_takes(
    capfd: pytest.CaptureFixture[str],
) -> None:
    wrong, checked = [], set()
    for source, text in texts():
        for command, whole in found_in(text):
            if (command, whole) not in checked and (why := why_wrong(command, whole=whole)):
                wrong.append(f'{source}: {command}: {why}')
            checked.add((command, whole))
    assert wrong == [], capfd.readouterr().err
    assert sum(whole for _, whole in checked) > 80


def test_every_target_of_make_in_a_message_exists() -> None:
    targets = re.findall(r'^([a-z-]+):', (ROOT / 'Makefile').read_text(), re.MULTILINE)
    named = {(source, name) for source, text in texts() for name in _MAKE.findall(text)}
    assert [(source, name) for source, name in named if name not in targets] == []
    assert named
