# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A sample of the fault campaign ends as stated, one fault of each kind of cause in one graph."""

import pytest
from samples import sampled

from faults.__main__ import attempt
from faults.all_cases import all_cases

SAMPLE = (
    'node restarted, actuator, middle, lockstep, one clutch',
    'message dropped, each topic to controller, middle, lockstep, one clutch',
    'message reordered, each topic to handover, middle, lockstep, two clutches',
    'stamp off the grid, clutch/torque, middle, lockstep, one clutch',
    'second publisher, clutch/torque, middle, lockstep, one clutch',
    'another type, load/torque, start, realtime, one clutch',
    'value NaN, off_going/clutch/torque_request, middle, lockstep, two clutches',
    'long array, clutch/torque, middle, lockstep, one clutch',
)


@pytest.mark.parametrize('name', sampled(SAMPLE, every=3))
def test_a_fault_ends_as_stated_and_leaves_nothing(name: str) -> None:
    (case,) = [each for each in all_cases() if each.name == name]
    as_stated, seen = attempt(case)
    assert not seen.left
    assert as_stated, f'{seen.summary()}; stated: {case.stated.text}'
