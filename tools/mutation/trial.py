# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Try a mutation against the tests that run its line, those of least duration first."""

import time
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from mutation.operators import Mutation
from mutation.scratch_copy import ScratchCopy

FIRST_S = 90.0
"""Time of a first try, s."""
PORTION_S = 8.0
"""The tests run in two portions, the first of about this many seconds: fewer files to collect."""
COLLECT_S = 0.1
"""What collecting costs a test, s, about."""
HANG_S, HANG_RATIO = 40.0, 20.0
"""A test hangs if it runs for more than this time and this many times its usual time."""
CAUGHT, HANGS, LIVED, UNDECIDED, NOT_RUN = (
    'caught',
    'hangs',
    'lived',
    'undecided',
    'no test runs it',
)


class Outcome(NamedTuple):
    """Result of a trial."""

    state: str
    test: str
    """The test that failed or hung, or at which the time was over; empty if none."""
    tests: int
    """How many tests run its line."""
    taken_s: float


def try_mutation(
    copy: ScratchCopy,
    mutation: Mutation,
    tests: Sequence[str],
    durations_s: Mapping[str, float],
    limit_s: float = FIRST_S,
) -> Outcome:
    """
    Run the tests until one fails because of the mutation, or the time is over.

    A test that fails without the mutation too, as on a busy machine, is passed over.
    """
    start = time.monotonic()

    def outcome(state: str, test: str = '') -> Outcome:
        return Outcome(state, test, len(tests), time.monotonic() - start)

    if not tests:
        return outcome(NOT_RUN)
    for portion in _portions(tests, durations_s):
        remaining = list(portion)
        while remaining:
            left_s = limit_s - (time.monotonic() - start)
            if left_s <= 0.0:
                return outcome(UNDECIDED)
            with copy.mutated(mutation):
                ended = copy.run(remaining, left_s)
            if ended.state == 'passed':
                break
            if ended.state == 'late':
                usual_s = durations_s.get(ended.test, 0.0)
                hangs = ended.running_s > max(HANG_S, HANG_RATIO * usual_s)
                return outcome(HANGS if hangs else UNDECIDED, ended.test)
            failed = ended.test or remaining[0]  # it may fail before there is a test
            if copy.run([failed], FIRST_S).state == 'passed':
                return outcome(CAUGHT, ended.test or 'collection')
            remaining = remaining[remaining.index(failed) + 1 :]
    return outcome(LIVED)


def _portions(tests: Sequence[str], durations_s: Mapping[str, float]) -> Iterator[Sequence[str]]:
    total_s, count = 0.0, 0
    while count < len(tests) and total_s < PORTION_S:
        total_s += COLLECT_S + durations_s[tests[count]]
        count += 1
    yield tests[:count]
    if count < len(tests):
        yield tests[count:]
