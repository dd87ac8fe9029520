# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
All cases of the campaign: each kind of fault once per place where the code path differs.

Every part lists its targets. They are no products: what happens to one node of a kind happens to
the others, so a fault is tried on the owner of time, on the recorder, on a node in the chain of
replies, and on one of the second clutch where its path is another.
"""

from functools import cache
from itertools import chain

from faults import (
    hop_cases,
    process_cases,
    program_cases,
    restart_cases,
    spoilt_cases,
    stranger_cases,
)
from faults.case import Case


@cache
def all_cases() -> tuple[Case, ...]:
    """Return all cases; no two have one name."""
    parts = (
        *(program_cases, hop_cases, stranger_cases),
        *(spoilt_cases, restart_cases, process_cases),
    )
    cases = tuple(chain.from_iterable(part.cases() for part in parts))
    names = [case.name for case in cases]
    assert len(set(names)) == len(names), 'two cases with one name'
    return cases
