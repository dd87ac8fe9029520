# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `ddct`: starts any program of the installed packages, nodes too, by its name."""

import ast
import sys
from collections.abc import Callable
from importlib.metadata import EntryPoint
from importlib.util import find_spec
from itertools import groupby
from pathlib import Path

from ddct_bringup import processes
from ddct_plant.base.errors import DdctError
from ddct_plant.base.options import close_name
from ddct_plant.graph.domain import require_ros
from ddct_plant.program.command_line import ProgramParser, load_program, programs, run_program

PROGRAM = 'ddct'
_FIRST_OF_ROS = ('rclpy', 'rcl_interfaces')
"""Modules that a node imports first of ROS."""
_RUNS_GRAPHS = ('bringup', 'compare')
"""Programs whose fork server starts ahead of them, as both take about as long to import."""
_WITHOUT_NODES = {'-h', '--help', '--headless', '--list', '--single-process', '--version'}
"""Options with which those programs start no node."""

_EXAMPLES = """\
examples:
  ddct compare --controllers pi,ls8 --out runs/first
  ddct compare --help
  ddct controller --ros-args -p controller:=ls8
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return the exit code of the one that it starts."""
    return run_program(PROGRAM, _ddct, argv)


def _ddct(argv: list[str]) -> int:
    known = programs()
    if not argv or argv[0] not in known:
        parser = ProgramParser(
            prog=PROGRAM,
            usage='%(prog)s PROGRAM [ARGUMENTS ...]',
            description='Start a program. Its own --help says what it takes.\n\n'
            + _listing(known),
            epilog=_EXAMPLES,
        )
        parser.add_argument('program', metavar='PROGRAM', help='one of those above')
        name = parser.parse_args(argv[:1]).program
        parser.error(f'unknown program {name}: {close_name(name, sorted(known))}')
    if _starts_nodes(argv):
        require_ros()
        # Imported here: what is imported before `run_program` cannot be interrupted without a
        # traceback.
        processes.start_server()
    sys.argv[1:] = argv[1:]
    return _load(known[argv[0]])()


def _starts_nodes(argv: list[str]) -> bool:
    return argv[0] in _RUNS_GRAPHS and _WITHOUT_NODES.isdisjoint(argv)


def _load(point: EntryPoint) -> Callable[[], int]:
    """Import a program; raise DdctError, with the page to read where ROS is not installed."""
    try:
        return load_program(point)
    except DdctError as error:
        if getattr(error.__cause__, 'name', None) in _FIRST_OF_ROS:
            require_ros()
        raise


def _listing(known: dict[str, EntryPoint]) -> str:
    """Return a line per program, by package."""
    points = sorted(known.values(), key=lambda point: (_package(point), point.name))
    width = max((len(name) for name in known), default=0)
    lines = []
    for package, group in groupby(points, _package):
        lines += [f'{package}:', *(f'  {each.name:{width}}  {_task(each)}' for each in group), '']
    return '\n'.join(lines).rstrip()


def _package(point: EntryPoint) -> str:
    return point.module.partition('.')[0]


def _task(point: EntryPoint) -> str:
    """Return the task in the first line of the program's module, without importing it."""
    try:
        spec = find_spec(point.module)
        source = Path(spec.origin).read_text(encoding='utf-8') if spec and spec.origin else ''
        first, *_ = (ast.get_docstring(ast.parse(source)) or point.value).splitlines()
    except (ImportError, OSError, SyntaxError, ValueError) as error:
        return f'cannot be read: {error}'
    return first.rpartition(f' `{point.name}`: ')[2]
