# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Start an installed program by its name; an interruption of its imports ends it as any other."""

import sys
from collections.abc import Callable
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

from ddct_plant.base.errors import DdctError
from ddct_plant.program.command_line import run_program
from ddct_plant.program.supervision import interrupted_by

GROUP = 'ddct.programs'
"""Group of the programs' entry points, which the packages' setup.py declare."""


def main() -> int:
    """Run the program that has the name of this script, and return its exit code."""
    name = Path(sys.argv[0]).name

    def start(_argv: list[str]) -> int:
        known = programs()
        if name not in known:
            raise DdctError(f'no program has this name: choose from {", ".join(sorted(known))}')
        return load_program(known[name])()

    return run_program(name, start, None)


def programs() -> dict[str, EntryPoint]:
    """Return the programs by name; of two with the same name the first on Python's path."""
    return {point.name: point for point in reversed(tuple(entry_points(group=GROUP)))}


def load_program(point: EntryPoint) -> Callable[[], int]:
    """Import a program; raise DdctError where a package that it needs is not installed."""
    try:
        loaded: Callable[[], int] = point.load()
    except ImportError as error:
        if interrupted_by():  # some modules report any failure in them as one of an import
            raise
        raise DdctError(f'{point.name} cannot start: {error}: install what it needs') from error
    if interrupted_by():  # a module has dropped it
        raise KeyboardInterrupt
    return loaded
