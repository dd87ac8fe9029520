# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The graph in real time for minutes, beside a bare chain in the same minutes."""

import argparse
import json
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ddct_plant.base.timebase import PERIOD_S
from soak.conditions import CONDITIONS, measure
from soak.sides import SoakError

PERCENTS = (50.0, 99.0, 99.9, 100.0)


def main() -> int:
    """Run the program and return its exit code."""
    parser = argparse.ArgumentParser(prog='tools/run soak', description=__doc__)
    parser.add_argument(
        'conditions', nargs='*', metavar='CONDITION', help=f'some of {", ".join(CONDITIONS)}'
    )
    parser.add_argument('--minutes', type=float, default=10.0, help='of each condition')
    parser.add_argument('--json', type=Path, help='file of what was measured')
    options = parser.parse_args()
    names = options.conditions or ['idle', 'busy']
    if unknown := set(names) - set(CONDITIONS):
        parser.error(f'no condition {min(unknown)}: choose from {", ".join(CONDITIONS)}')
    # So that nothing is left behind.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    measured = []
    for name in names:
        print(f'{CONDITIONS[name].what}, {options.minutes:g} minutes', flush=True)
        measured.append(measure(name, round(options.minutes * 60.0 / PERIOD_S)))
        for line in _lines(measured[-1]):
            print(line, flush=True)
    if options.json:
        options.json.write_text(f'{json.dumps(measured)}\n', encoding='utf-8')
    return 0


def _lines(found: dict[str, Any]) -> Iterator[str]:
    """Yield the tables of a condition: misses and durations, then what each process used."""
    yield f'{"":28}' + ''.join(f'{f"p{percent:g}":>9}' for percent in PERCENTS)
    for name, side in found['sides'].items():
        yield f'{name}: {side["missed_steps"]} of {side["steps"]} steps missed'
        # A tick is late by the time since it was due: the differences are those of the periods.
        jitter_us = np.abs(np.diff(side['lateness_us']))
        rows = {
            'lateness': side['lateness_us'],
            'jitter': jitter_us,
            'latency': side['latency_us'],
        }
        for duration, samples_us in rows.items():
            tail_ms = np.percentile(samples_us, PERCENTS) / 1e3
            yield f'{f"  {duration} in ms":28}' + ''.join(f'{ms:9.2f}' for ms in tail_ms)
    for name, use in found['processes'].items():
        yield (
            f'{name:28}{100.0 * use["core_share"]:7.1f} % of a core, {use["memory_mb"]:.0f} MB, '
            f'{use["growth_mb"]:.1f} MB more than at the start'
        )


if __name__ == '__main__':
    try:
        sys.exit(main())
    except SoakError as error:
        sys.exit(f'tools/run soak: {error}')
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)
