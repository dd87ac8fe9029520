# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Count the classes and functions that a headless run enters, in memory and with its bag.

    tools/run entered                              a launch and a gear shift
    tools/run entered --scenario launch --names    one of them, with the names

The way is what is on the stack when the equations of the plant are entered in the periods of the
run, from `compare` to these equations. A method counts as its class.
"""

import argparse
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

from ddct_bringup import api
from ddct_bringup.programs import compare
from ddct_plant.base.errors import DdctError
from entered.counter import Entered, Noun


def main() -> int:
    """Run the program and return its exit code."""
    parser = argparse.ArgumentParser(
        prog='tools/run entered',
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        '--scenario', action='append', metavar='NAME', help='default: launch and upshift'
    )
    parser.add_argument('--controller', default='pi', help='default: %(default)s')
    parser.add_argument(
        '--option',
        action='append',
        default=[],
        metavar='KEY=VALUE',
        help='an option of `ddct compare`, such as architecture=base',
    )
    parser.add_argument('--names', action='store_true', help='also print those on the way')
    options = parser.parse_args()
    if unclear := [each for each in options.option if '=' not in each]:
        parser.error(f'--option {unclear[0]}: give KEY=VALUE')
    given = dict(each.split('=', 1) for each in options.option)
    print(f'{"":26}{"on the way":>12}{"classes":>10}{"functions":>11}{"modules":>9}{"in all":>9}')
    for scenario in options.scenario or ['launch', 'upshift']:
        for name, run in _runs(scenario, options.controller, given).items():
            entered = Entered()
            entered.call(run)
            print(f'{f"{scenario}, {name}":26}{_counts(entered.way)}{len(entered.nouns):9}')
            if options.names:
                for noun in sorted(entered.way):
                    print(f'    {noun.module}: {noun.name}')
    return 0


def _runs(
    scenario: str, controller: str, given: Mapping[str, Any]
) -> dict[str, Callable[[], object]]:
    """Return the same run by name: in memory, and with its bag, its scores and its page."""

    def with_bag() -> None:
        arguments = [f'--controllers={controller}', '--headless', f'--scenario={scenario}']
        arguments += [f'--{key}={value}' for key, value in given.items()]
        printed = StringIO()
        with tempfile.TemporaryDirectory() as folder, redirect_stdout(printed):
            out = Path(folder) / 'out'
            with redirect_stderr(printed):
                code = compare.main([*arguments, '--floors=none', f'--out={out}'])
        if code:
            sys.exit(f'entered: {printed.getvalue().strip()}')

    return {
        'in memory': lambda: api.compare(controller, scenario=scenario, **given),
        'with its bag': with_bag,
    }


def _counts(nouns: Iterable[Noun]) -> str:
    """Return how many there are, of which classes and functions, and in how many modules."""
    found = list(nouns)
    classes = sum(noun.is_class for noun in found)
    modules = {noun.module for noun in found}
    return f'{len(found):12}{classes:10}{len(found) - classes:11}{len(modules):9}'


if __name__ == '__main__':
    try:
        sys.exit(main())
    except DdctError as error:
        sys.exit(f'entered: {error}')
