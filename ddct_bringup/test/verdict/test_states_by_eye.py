# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The rules agree with judgement by eye on a sample of runs that they were not written for."""

import pytest
from labelled_runs import labelled_runs

from ddct_bringup.verdict.state import ENGAGED, NEARLY_ENGAGED

pytestmark = pytest.mark.slow

PARTS = ('development', 'first_check', 'held_out', 'rev_limiter')
EVERY = 8
"""Distance of the runs of the sample; `tests/nightly/verdict` has all 372."""


@pytest.mark.slow
@pytest.mark.filterwarnings('ignore::RuntimeWarning')  # a slip of 1e6 rpm
def test_the_states_of_a_sample_are_those_by_eye_or_the_second_label() -> None:
    # A chart does not show whether plates that hardly slip are locked.
    judged = [
        (run, run.state_by_rules().replace(NEARLY_ENGAGED, ENGAGED))
        for part in PARTS
        for run in labelled_runs(part)[::EVERY]
    ]
    assert len(judged) == 48
    assert [run for run, state in judged if state not in (run.state, run.second)] == []
    assert sum(state == run.state for run, state in judged) >= 45
