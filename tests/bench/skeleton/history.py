# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The record of one bench, and the history: one file per kind of machine, one record a line."""

import json
import os
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from bench.skeleton.machine import Machine
from bench.skeleton.rounds import Result
from bench.skeleton.workspace import ROOT

HISTORY = ROOT / 'docs' / 'develop' / 'speed'
"""Folder of the files `KIND.jsonl`, which docs/develop/speed.md is drawn from."""
FEWEST_ROUNDS = 3
"""Fewest rounds of a bench that goes into the history."""


def record_of(
    results: Sequence[Result], machine: Machine, rounds: int, base: str, load: float
) -> dict[str, Any]:
    """
    Return the record of a bench.

    `base` is the id of the base commit or empty; `load` is the number of processes that wanted a
    core in the minute before the first round.
    """
    return {
        'time': time.strftime('%Y-%m-%dT%H:%MZ', time.gmtime()),
        'commit': git('rev-parse', 'HEAD')[:10],
        'changed': bool(git('status', '--porcelain', '--untracked-files=no')),
        'base': base[:10],
        'rounds': rounds,
        'load': round(load, 1),
        'machine': machine.as_json(),
        'figures': [_figure(result) for result in results],
    }


def load_now() -> float:
    """Return the mean number of processes in the last minute that ran or waited for a core."""
    return os.getloadavg()[0]


def append(record: dict[str, Any], machine: Machine, folder: Path = HISTORY) -> Path:
    """Append a record to the file of its kind of machine, and return the file."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f'{machine.slug}.jsonl'
    with file.open('a', encoding='utf-8') as lines:
        lines.write(f'{json.dumps(record)}\n')
    return file


def _figure(result: Result) -> dict[str, Any]:
    found: dict[str, Any] = {
        'name': result.name,
        'reference': result.reference,
        'outcome': result.outcome,
        'bound': result.bound,
    }
    if result.ratios:
        found['ratio'] = _rounded(result.median)
        found['rounds'] = [_rounded(ratio) for ratio in result.ratios]
    if result.reason:
        found['reason'] = result.reason
    if result.point:
        found['over'] = {result.point.abscissa: result.point.value}
    return found


def _rounded(ratio: float) -> float:
    return float(f'{ratio:.4g}')


def git(*arguments: str) -> str:
    """Return what git prints in this repository; empty without one."""
    done = subprocess.run(
        ['git', '-C', str(ROOT), *arguments], capture_output=True, text=True, check=False
    )
    return done.stdout.strip()
