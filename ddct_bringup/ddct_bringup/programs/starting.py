# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Start one of several programs by its name, and list them with what they do."""

import ast
import sys
from collections.abc import Iterable
from importlib.metadata import EntryPoint
from importlib.util import find_spec
from pathlib import Path

from ddct_plant.base.errors import DdctError
from ddct_plant.graph.domain import require_ros
from ddct_plant.program.command_line import load_program

_FIRST_OF_ROS = ('rclpy', 'rcl_interfaces')
"""Modules that a node imports first of ROS."""


def start(point: EntryPoint, argv: list[str]) -> int:
    """
    Run a program with these arguments and return its exit code.

    Raise DdctError where it cannot be imported, with the page to read where ROS is missing.
    """
    sys.argv[1:] = argv
    try:
        main = load_program(point)
    except DdctError as error:
        if getattr(error.__cause__, 'name', None) in _FIRST_OF_ROS:
            require_ros()
        raise
    return main()


def lines_of(points: Iterable[EntryPoint], width: int) -> list[str]:
    """Return a line per program: its name, padded to a width, and what it does."""
    return [f'  {point.name:{width}}  {_task(point)}' for point in points]


def _task(point: EntryPoint) -> str:
    """Return the task in the first line of the program's module, without importing it."""
    try:
        spec = find_spec(point.module)
        source = Path(spec.origin).read_text(encoding='utf-8') if spec and spec.origin else ''
        first, *_ = (ast.get_docstring(ast.parse(source)) or point.value).splitlines()
    except (ImportError, OSError, SyntaxError, ValueError) as error:
        return f'cannot be read: {error}'
    return first.rpartition(f' `{point.name}`: ')[2]
