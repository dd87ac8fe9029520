# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
`make bench`: each figure is a ratio to a reference that is measured in turn with it.

    make bench                            all figures but those that need a base commit
    make bench BASE=HEAD~5                with another commit as a further reference
    make bench WHAT='graph stick' ROUNDS=3 only figures whose name has one of the words
    make bench WHAT=suite BASE=HEAD~5     the tests of both versions, tens of minutes

The exit code is 1 when every round of a figure is beyond its bound, or a figure fails.
"""

import argparse
import json
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from bench.comparisons import ALL
from bench.skeleton.base_commit import base_workspace, commit_of
from bench.skeleton.comparison import Bench, Comparison
from bench.skeleton.history import FEWEST_ROUNDS, HISTORY, append, load_now, record_of
from bench.skeleton.interruption import interrupt_once
from bench.skeleton.machine import this_machine
from bench.skeleton.output import Progress, list_of, table_of
from bench.skeleton.rounds import BAD, Result, measure
from bench.skeleton.workspace import ROOT, ProgramError, Workspace


def main() -> int:
    """Measure, print the table, keep the record, and return the exit code."""
    options = _options()
    chosen = choose(ALL, options.what)
    if options.list:
        print('\n'.join(list_of(chosen)))
        return 0
    if not chosen:
        sys.exit(f'bench: no figure has {" or ".join(options.what)} in its name: see --list')
    interrupt_once()
    machine, load = this_machine(), load_now()
    try:
        with _bench(options.base) as bench:
            results = measure_all(chosen, bench, options.rounds)
    except KeyboardInterrupt:
        print('\nbench: interrupted, nothing is kept', file=sys.stderr, flush=True)
        # All is cleaned up; threads of foreign packages may wait for what no longer comes.
        os._exit(128 + signal.SIGINT)
    except ProgramError as error:
        sys.exit(f'bench: BASE: the base commit cannot be set up: {error}')
    base = commit_of(options.base) if options.base else ''
    record = record_of(results, machine, options.rounds, base, load)
    _write(record, options.json)
    if options.json != '-':
        print(table_of(results))
    if options.history and options.rounds >= FEWEST_ROUNDS:
        file = append(record, machine, options.history)
        print(f'bench: a record was added to {file}: make docs KINDS=speed', file=sys.stderr)
    return int(any(result.outcome in BAD for result in results))


def choose(comparisons: list[Comparison], words: list[str]) -> list[Comparison]:
    """
    Return the comparisons whose name has one of the words; without words the usual ones.

    A word that is a whole name chooses that one alone.
    """
    if not words:
        return [each for each in comparisons if not each.only_by_name]
    whole = {each.name for each in comparisons}.intersection(words)
    parts = [word for word in words if word not in whole]
    return [
        each
        for each in comparisons
        if each.name in whole or any(word in each.name for word in parts)
    ]


def measure_all(comparisons: list[Comparison], bench: Bench, rounds: int) -> list[Result]:
    """Return the results of all comparisons in order; their progress is on standard error."""
    progress = Progress(len(comparisons), rounds)
    results: list[Result] = []
    for number, each in enumerate(comparisons, 1):
        found = measure(each, bench, rounds, partial(progress.during, number, each.name))
        progress.after(number, found)
        results += found
    return results


@contextmanager
def _bench(base: str | None) -> Iterator[Bench]:
    ours = Workspace(ROOT)
    if not base:
        yield Bench(ours)
        return
    with base_workspace(base) as workspace:
        yield Bench(ours, workspace)


def _write(record: object, target: str | None) -> None:
    text = json.dumps(record, indent=1)
    if target == '-':
        print(text)
    elif target:
        Path(target).write_text(f'{text}\n', encoding='utf-8')


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog='bench', description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument('what', nargs='*', metavar='WORD', help='part of the name of figures')
    parser.add_argument('--base', metavar='REV', help='commit to measure beside')
    parser.add_argument('--rounds', type=_count, default=5, help='default: 5')
    parser.add_argument('--json', metavar='FILE', help='write the record; - is standard output')
    parser.add_argument(
        '--history',
        type=lambda text: Path(text) if text else None,
        default=HISTORY,
        metavar='FOLDER',
        help=f'where records of {FEWEST_ROUNDS} or more rounds are kept; empty keeps none',
    )
    parser.add_argument('--list', action='store_true', help='list the figures and end')
    return parser.parse_args()


def _count(text: str) -> int:
    if not text.isdecimal() or not int(text):
        raise argparse.ArgumentTypeError(f'{text!r} is no number of rounds: give 1 or more')
    return int(text)


if __name__ == '__main__':
    raise SystemExit(main())
