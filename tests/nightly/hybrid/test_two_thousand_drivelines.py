# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Two thousand random drivelines by the hybrid integrator and by scipy's DOP853.

They have undamped modes to 600 rad/s and one to four friction elements. The other integration
has its own equations, search for events and choice of the mode.
"""

from driveline_reference import compared

COUNT = 2000


def test_events_and_speeds_are_those_of_another_method():
    """Only those with a graze or two events within 1e-6 s may differ, and at most 1 % do."""
    found = [compared(index) for index in range(COUNT)]
    differing = {i: each for i, each in enumerate(found) if not each.agrees}
    assert {i: each for i, each in differing.items() if not each.apart} == {}
    assert len(differing) <= COUNT // 100
    assert sum(each.events for each in found) >= 10 * COUNT
