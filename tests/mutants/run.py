# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
`make mutants`: seed every defect of tests/mutants/*.yaml in a scratch copy and run its tests.

A defect that its tests do not catch lives, and the exit code is 1; so it is for an entry whose
text is gone from its file, and for tests that fail without a defect. A defect whose tests are all
skipped, as an optional package is absent, is not tried and changes no exit code. README.md beside
this file has the rule for the list, and what `--json` keeps.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutant_entries import Mutant, read_mutants
from mutant_records import Records
from mutant_trials import AllSkippedError, TrialError, tests_pass

ROOT = Path(__file__).resolve().parents[2]
WORKERS = 2
CAUGHT, LIVED, ERROR, SKIPPED = 'caught', 'LIVED', 'ERROR', 'skipped'


def main(arguments: Sequence[str] | None = None) -> int:
    """Try the defects, print a table and return the exit code."""
    parser = argparse.ArgumentParser(description='Seed defects and see whether tests catch them.')
    parser.add_argument('files', nargs='*', type=Path, help='default: all of tests/mutants')
    parser.add_argument('--claim', default='', help='only defects whose claim has this text')
    parser.add_argument('--check', action='store_true', help='only find their texts and tests')
    parser.add_argument('--json', type=Path, help='file whose records of these are replaced')
    parser.add_argument('--missing', action='store_true', help='only defects without a record')
    parser.add_argument('--root', type=Path, default=ROOT, help='the repository')
    options = parser.parse_args(arguments)
    lists = sorted((options.root / 'tests' / 'mutants').glob('*.yaml'))
    try:
        mutants = [
            mutant
            for file in options.files or lists
            for mutant in read_mutants(file)
            if options.claim in mutant.claim
        ]
        for mutant in mutants:
            mutant.defective(options.root)
        if options.json is None:
            keep = _keep_nothing
        else:
            known = [mutant for file in lists for mutant in read_mutants(file)]
            records = Records(options.json, known, options.root)
            keep = records.keep
            mutants = [each for each in mutants if not (options.missing and records.has(each))]
    except (OSError, ValueError) as error:
        print(f'mutants: {error}', file=sys.stderr)
        return 1
    return 0 if options.check else try_all(options.root, mutants, keep)


def _keep_nothing(_mutant: Mutant, _outcome: str) -> None:
    pass


def try_all(
    root: Path, mutants: Sequence[Mutant], keep: Callable[[Mutant, str], None] = _keep_nothing
) -> int:
    """
    Try each set of tests without a defect, then each defect; return the exit code.

    `keep` is called with each defect that was tried, and its outcome.
    """
    with ThreadPoolExecutor(WORKERS) as pool:
        test_sets = list(dict.fromkeys(mutant.tests for mutant in mutants))
        obstacles = dict(
            zip(test_sets, pool.map(lambda tests: _obstacle(root, tests), test_sets), strict=True)
        )
        outcomes = []
        for mutant, outcome in zip(
            mutants, pool.map(lambda m: obstacles[m.tests] or _try(root, m), mutants), strict=True
        ):
            print(f'{outcome:6}  {mutant.file}: {mutant.claim}', flush=True)
            outcomes.append(outcome)
            if outcome != SKIPPED:
                keep(mutant, outcome)
    print(', '.join(f'{outcomes.count(kind)} {kind}' for kind in (CAUGHT, LIVED, ERROR, SKIPPED)))
    return int(LIVED in outcomes or ERROR in outcomes)


def _obstacle(root: Path, tests: Sequence[str]) -> str:
    """Return '' if the tests pass without a defect, else the outcome; print why on stderr."""
    try:
        if tests_pass(root, tests):
            return ''
        print(f'mutants: without a defect these fail: {" ".join(tests)}', file=sys.stderr)
    except AllSkippedError as error:
        print(f'mutants: {error}', file=sys.stderr)
        return SKIPPED
    except TrialError as error:
        print(f'mutants: {error}', file=sys.stderr)
    return ERROR


def _try(root: Path, mutant: Mutant) -> str:
    """Return whether the tests caught the defect."""
    try:
        return LIVED if tests_pass(root, mutant.tests, mutant) else CAUGHT
    except TrialError as error:
        print(f'mutants: {mutant.claim}: {error}', file=sys.stderr)
        return ERROR


if __name__ == '__main__':
    sys.exit(main())
