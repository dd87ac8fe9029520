# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Try random mutations of the product against the suite.

`tools/run mutation --help` has the options of the steps:

    copy    make a scratch copy of a commit, with an environment of its own
    cover   run the suite in a copy and record which tests run which lines
    draw    draw mutations by room, in proportion to code
    try     try drawn mutations in copies, one at a time in each
    show    print what came out, by room

A mutation that lives is a hole in the tests, or equivalent: read it and say which.
"""

import argparse
import json
import queue
import subprocess
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from mutation.coverage_map import CoverageMap
from mutation.draw import draw, find_again, room_of
from mutation.operators import Mutation
from mutation.scratch_copy import ScratchCopy
from mutation.trial import CAUGHT, FIRST_S, HANGS, UNDECIDED, try_mutation

GONE = 'gone'
"""State of a mutation whose statement this commit does not have."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Do one of the steps and return the exit code."""
    parser = argparse.ArgumentParser(
        prog='tools/run mutation',
        description='Try random mutations of the product against the suite.',
    )
    steps = parser.add_subparsers(required=True)
    step = steps.add_parser('copy', help='make a scratch copy of a commit')
    step.add_argument('root', type=Path)
    step.add_argument('--commit', default='HEAD')
    step.add_argument('--repository', type=Path, default=Path.cwd())
    step.set_defaults(work=_copy)
    step = steps.add_parser('cover', help='record which tests run which lines')
    step.add_argument('copy', type=Path)
    step.add_argument('records', type=Path, help='a new folder')
    step.add_argument('pytest', nargs='*', help='arguments of pytest, after --')
    step.set_defaults(work=_cover)
    step = steps.add_parser('draw', help='draw mutations, of a copy in which none is tried')
    step.add_argument('copy', type=Path)
    step.add_argument('records', type=Path)
    step.add_argument('--out', type=Path, required=True)
    step.add_argument('--count', type=int, default=130)
    step.add_argument('--graph', type=int, default=0, help='further ones that only a graph runs')
    step.add_argument('--seed', type=int, required=True)
    step.add_argument('--changed-since', help='only files that have changed since this commit')
    step.set_defaults(work=_draw)
    step = steps.add_parser('try', help='try mutations; finished ones are kept')
    step.add_argument('drawn', type=Path)
    step.add_argument('records', type=Path)
    step.add_argument('copies', type=Path, nargs='+')
    step.add_argument('--out', type=Path, required=True)
    step.add_argument('--limit', type=float, default=FIRST_S, help='s for each')
    step.set_defaults(work=_try)
    step = steps.add_parser('show', help='print what came out')
    step.add_argument('outcomes', type=Path)
    step.set_defaults(work=_show)
    options = parser.parse_args(arguments)
    result: int = options.work(options)
    return result


def _copy(options: argparse.Namespace) -> int:
    ScratchCopy.make(options.repository.resolve(), options.commit, options.root)
    return 0


def _cover(options: argparse.Namespace) -> int:
    return ScratchCopy(options.copy).record(options.records.resolve(), options.pytest)


def _draw(options: argparse.Namespace) -> int:
    root = options.copy.resolve()
    files = None
    if options.changed_since:
        listed = ['git', '-C', root, 'diff', '--name-only', options.changed_since, '--', '*.py']
        files = subprocess.run(listed, check=True, capture_output=True, text=True).stdout.split()
    drawn = draw(root, options.count, options.seed, files)
    if options.graph:
        known = CoverageMap(options.records.resolve(), root)
        drawn += draw(
            root,
            options.graph,
            options.seed,
            files,
            lambda each: each not in drawn and known.only_a_graph(each.file, each.line),
        )
    text = json.dumps([each.as_json() for each in drawn], indent=1)
    options.out.write_text(text, encoding='utf-8')
    return 0


def _try(options: argparse.Namespace) -> int:
    drawn = [Mutation(**each) for each in json.loads(options.drawn.read_text(encoding='utf-8'))]
    copies: queue.SimpleQueue[ScratchCopy] = queue.SimpleQueue()
    for root in options.copies:
        copies.put(ScratchCopy(root))
    known = CoverageMap(options.records.resolve(), options.copies[0].resolve())
    done = _outcomes(options.out)

    def work(earlier: Mutation, now: Mutation | None) -> None:
        copy = copies.get()
        try:
            if now is None:
                entry: dict[str, Any] = {'state': GONE}
            else:
                tests = known.tests_of(now.file, now.line)
                entry = try_mutation(copy, now, tests, known.durations_s, options.limit)._asdict()
        finally:
            copies.put(copy)
        line = json.dumps({'mutation': earlier.as_json(), **entry})
        with options.out.open('a', encoding='utf-8') as file:
            file.write(line + '\n')
        print(f'{entry["state"]:16} {earlier.name[:140]}', flush=True)

    decided = {name for name, entry in done.items() if entry['state'] != UNDECIDED}
    with ThreadPoolExecutor(len(options.copies)) as pool:
        found = find_again(options.copies[0].resolve(), drawn)
        jobs = [
            pool.submit(work, earlier, now)
            for earlier, now in zip(drawn, found, strict=True)
            if earlier.name not in decided
        ]
        for job in jobs:
            job.result()
    return 0


def _outcomes(file: Path) -> dict[str, dict[str, Any]]:
    """Return the last outcome of each mutation by its name."""
    if not file.exists():
        return {}
    entries = map(json.loads, file.read_text(encoding='utf-8').splitlines())
    return {Mutation(**entry['mutation']).name: entry for entry in entries}


def _show(options: argparse.Namespace) -> int:
    outcomes = _outcomes(options.outcomes)
    rooms: dict[str, Counter[str]] = {}
    for entry in outcomes.values():
        rooms.setdefault(room_of(entry['mutation']['file']), Counter())[entry['state']] += 1
    for room, counts in sorted(rooms.items()):
        print(f'{room:40}', ', '.join(f'{count} {state}' for state, count in counts.items()))
    print('all', dict(Counter(entry['state'] for entry in outcomes.values())))
    for name, entry in outcomes.items():
        if entry['state'] not in (CAUGHT, HANGS):
            print(f'{entry["state"]:16} {name}  ({entry.get("tests", 0)} tests)')
    return 0


if __name__ == '__main__':
    raise SystemExit(main())
