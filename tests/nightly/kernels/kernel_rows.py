# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Rows of the packaged controllers on other kernels of OpenBLAS, compared as `verify` compares them.

    . install/setup.bash; .venv/bin/python tests/nightly/kernels/kernel_rows.py Haswell Prescott

prints for each controller how many quick development cases are the same within the bound, how
many are within the bound that was measured for them, and which are beyond. It takes ten minutes.
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.campaign.columns import COMPARED
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verification.comparison import BOUND, Comparison, plain_json
from ddct_bringup.verification.rounding_bound import LARGEST, bound_of_row
from ddct_controllers.registry import own_controller_names
from ddct_plant.program.workers import in_processes

Row = Mapping[str, Any]
_CHILD = '--rows'


class Pair(NamedTuple):
    """Index of a run, the largest difference of its rows on both kernels, and its bound."""

    run: int
    difference: float
    bound: float


CAMPAIGN = Cases.packaged(quick=True).development(own_controller_names(), Path())
"""Quick development cases with every packaged controller."""


def row(index: int) -> Row:
    """Return the row of a run, without floors, as JSON has it."""
    (found,) = Scorer(packaged_limits(), at_once=False).scored(CAMPAIGN.planned(index, index + 1))
    columns = found.row()
    return {name: plain_json(columns[name]) for name in COMPARED}


def rows_here(indices: Sequence[int]) -> list[Row]:
    """Return the rows of runs on the kernels of this process."""
    with in_processes(lambda place: row(indices[place]), len(indices)) as found:
        return list(found)


def rows_on(kernels: str, indices: Sequence[int]) -> list[Row]:
    """Return the rows of runs in another process with the kernels of that name."""
    done = subprocess.run(
        [sys.executable, __file__, _CHILD],
        input=json.dumps(list(indices)),
        env={**os.environ, 'OPENBLAS_CORETYPE': kernels, 'PYTHONPATH': ':'.join(sys.path)},
        capture_output=True,
        text=True,
        check=True,
    )
    found: list[Row] = json.loads(done.stdout)
    return found


def pairs(indices: Sequence[int], ours: Sequence[Row], theirs: Sequence[Row]) -> Iterator[Pair]:
    """Yield each run with its difference, and the bound that `verify` uses for it."""
    differences = []
    for here, there in zip(ours, theirs, strict=True):
        comparison = Comparison()
        comparison.add_nested('', here, there)
        differences.append(comparison.largest)

    def bound(place: int) -> float:
        if not BOUND < differences[place] <= LARGEST:
            return BOUND
        (run,) = CAMPAIGN.planned(indices[place], indices[place] + 1)
        return bound_of_row(run, packaged_limits())

    with in_processes(bound, len(indices), chunk=1) as bounds:
        for index, difference, each in zip(indices, differences, bounds, strict=True):
            yield Pair(index, difference, each)


def main(kernels: Sequence[str]) -> int:
    """Compare all controllers on some kernels with those here, and print a line for each."""
    indices, beyond = range(CAMPAIGN.runs), 0
    ours = rows_here(indices)
    for name in kernels:
        found = list(pairs(indices, ours, rows_on(name, indices)))
        for number, label in enumerate(CAMPAIGN.labels):
            part = found[number * CAMPAIGN.cases : (number + 1) * CAMPAIGN.cases]
            measured = [each for each in part if each.bound > BOUND]
            wrong = [each for each in part if each.difference > each.bound]
            largest = max(each.difference for each in part)
            print(
                f'{name:10} {label:16} {len(part) - len(measured) - len(wrong):3} within {BOUND:g}'
                f' {len(measured):3} within a measured bound, at most {largest:.1e}, beyond: '
                + (', '.join(f'case {each.run % CAMPAIGN.cases}' for each in wrong) or 'none'),
                flush=True,
            )
            beyond += len(wrong)
    return 1 if beyond else 0


if __name__ == '__main__':
    if sys.argv[1:] == [_CHILD]:
        json.dump(rows_here(json.load(sys.stdin)), sys.stdout)
    else:
        sys.exit(main(sys.argv[1:] or ['Prescott']))
