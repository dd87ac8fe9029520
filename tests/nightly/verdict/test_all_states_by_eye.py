# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The rules agree with judgement by eye on runs that they were not written for."""

from dataclasses import replace

import pytest
from labelled_runs import labelled_runs

from ddct_bringup.verdict.state import ENGAGED, NEARLY_ENGAGED

AGREED = {
    'development': (45, 47),
    'first_check': (187, 196),
    'held_out': (77, 84),
    'rev_limiter': (39, 41),
}
"""Number of runs with the state by eye, and of those with it or with the second state."""


@pytest.mark.filterwarnings('ignore::RuntimeWarning')  # a slip of 1e6 rpm
@pytest.mark.parametrize('part', AGREED)
def test_as_many_states_agree_with_those_by_eye_as_when_the_rules_were_set(part):
    # A chart does not show whether plates that hardly slip are locked.
    judged = [
        (run, state.replace(NEARLY_ENGAGED, ENGAGED))
        for run in labelled_runs(part)
        for state in [run.state_by_rules()]
    ]
    agreed = sum(state == run.state for run, state in judged)
    accepted = sum(state in (run.state, run.second) for run, state in judged)
    assert agreed >= AGREED[part][0]
    assert accepted >= AGREED[part][1]


def test_no_run_is_in_two_parts():
    settings = [
        replace(run, state='', second=None) for part in AGREED for run in labelled_runs(part)
    ]
    assert len(settings) == len(set(settings))
