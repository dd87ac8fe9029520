# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""All cases of the campaign, in the order of the table."""

from functools import cache
from itertools import chain

from faults.campaign import (
    hop_cases,
    process_cases,
    program_cases,
    restart_cases,
    spoilt_cases,
    stranger_cases,
)
from faults.campaign.case import Case


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
