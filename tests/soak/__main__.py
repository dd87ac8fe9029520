# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`make soak`: the graph in real time for minutes, beside a bare chain in the same minutes."""

import argparse
import json
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from bench.skeleton.history import git
from bench.skeleton.interruption import interrupt_once
from bench.skeleton.machine import this_machine
from bench.skeleton.workspace import ROOT
from soak.conditions import CONDITIONS, kernel, measure
from soak.sides import SoakError

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.files.output_file import write_text
from ddct_plant.ticks.durations import checked

RECORD = ROOT / 'docs' / 'use' / 'real_time.json'
"""Record that docs/use/real_time.md shows."""
SHORTEST_MIN, LONGEST_MIN = 0.5, 60.0


def main() -> int:
    """Run the program and return its exit code."""
    options = _parsed()
    interrupt_once()
    steps = round(options.minutes * 60.0 / PERIOD_S)
    machine = this_machine().as_json() | {'kernel': kernel()}
    new = []
    try:
        for name in options.conditions:
            print(f'soak: {CONDITIONS[name].what}, {options.minutes:g} minutes', flush=True)
            new.append(_version() | measure(name, steps))
            for side, found in new[-1]['sides'].items():
                print(f'soak: {side}: {_line(found)}', flush=True)
    except SoakError as error:
        print(f'soak: {error}', file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    write_text(str(options.json), json.dumps(renewed(options.json, machine, new)) + '\n')
    print(f'soak: {options.json}; make docs KINDS=soak shows {RECORD.relative_to(ROOT)}')
    return 0


def _version() -> dict[str, Any]:
    """Return when, and of which commit, a condition is measured."""
    return {
        'time': time.strftime('%Y-%m-%dT%H:%MZ', time.gmtime()),
        'commit': git('rev-parse', 'HEAD')[:10],
        'changed': bool(git('status', '--porcelain', '--untracked-files=no')),
    }


def renewed(
    file: Path, machine: Mapping[str, Any], new: Sequence[dict[str, Any]]
) -> dict[str, Any]:
    """Return the record with the new conditions, and those of before of the same machine."""
    measured = {}
    if file.exists():
        record = json.loads(file.read_text(encoding='utf-8'))
        if record['machine'] == machine:
            measured = {each['condition']: each for each in record['measured']}
    measured |= {each['condition']: each for each in new}
    return {
        'machine': machine,
        'measured': [measured[name] for name in CONDITIONS if name in measured],
    }


def _line(found: dict[str, Any]) -> str:
    """Return the missed steps of a side, and percentiles of its durations in ms."""
    parts = [f'{found["missed_steps"]} of {found["steps"]} steps missed']
    for name, values in found['durations'].items():
        counts = {int(place): count for place, count in values['counts'].items()}
        histogram = checked(values['largest_us'], counts)
        tail = [histogram.percentile_us(percent) or 0.0 for percent in (50.0, 99.0, 99.9, 100.0)]
        parts.append(f'{name} {" ".join(f"{each / 1e3:.2f}" for each in tail)} ms')
    return ', '.join(parts)


def _parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog='make soak', description=__doc__)
    parser.add_argument('conditions', nargs='*', help=f'some of {", ".join(CONDITIONS)}')
    parser.add_argument('--minutes', type=float, default=10.0, help='of each condition')
    parser.add_argument(
        '--json', type=Path, default=RECORD, help='the record; default: %(default)s'
    )
    options = parser.parse_args()
    options.conditions = options.conditions or ['idle', 'busy']
    for name in options.conditions:
        if name not in CONDITIONS:
            parser.error(f'no condition {name}: choose from {", ".join(CONDITIONS)}')
    if not SHORTEST_MIN <= options.minutes <= LONGEST_MIN:
        parser.error(f'--minutes is {options.minutes:g}: give {SHORTEST_MIN:g} to {LONGEST_MIN:g}')
    return options


if __name__ == '__main__':
    raise SystemExit(main())
