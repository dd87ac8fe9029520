# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every case of the fault campaign ends as stated; `tools/run faults` prints what was observed."""

import pytest

from faults.__main__ import attempt_in_time
from faults.all_cases import all_cases
from faults.case import Case


@pytest.mark.parametrize('case', all_cases(), ids=lambda case: case.name)
def test_a_fault_ends_as_stated_and_leaves_nothing(case: Case) -> None:
    as_stated, seen, _ = attempt_in_time(case)
    assert not seen.left
    assert as_stated, f'{seen.summary()}; stated: {case.stated.text}'
