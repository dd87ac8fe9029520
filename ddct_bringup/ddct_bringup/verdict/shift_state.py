# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
States of a gear shift whose handover went wrong, by the rules of the limits file.

    tied_up   the clutches worked against each other
    flared    the engine ran up between the gears, though the shift was completed

Both are failures. A tie-up is the state also where it ended in a stalled engine or a car at rest.
"""

from ddct_bringup.metrics.shift.course import ShiftCourse
from ddct_bringup.verdict.rules import ShiftRules
from ddct_bringup.verdict.state import FLARED, INVALID, SUCCESSES, TIED_UP


def state_of_shift(state: str, course: ShiftCourse | None, rules: ShiftRules) -> str:
    """Return the state of a run, from that of its on-coming clutch and the course of its shift."""
    if course is None or state == INVALID:
        return state
    if (course.tie_up_work or 0.0) > rules.tie_up_work:
        return TIED_UP
    if state in SUCCESSES and (course.flare or 0.0) > rules.flare:
        return FLARED
    return state
