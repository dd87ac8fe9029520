# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Whether plates come together by the rules agrees with judgement by eye on a sample."""

import pytest
from labelled_runs import labelled_runs

from ddct_bringup.verdict.state import ENGAGED

pytestmark = pytest.mark.slow

PARTS = ('development', 'first_check', 'held_out', 'rev_limiter')
EVERY = 32
"""Distance of the runs of the sample; `tests/nightly/verdict` has all 372."""


@pytest.mark.slow
@pytest.mark.filterwarnings('ignore::RuntimeWarning')  # a slip of 1e6 rpm
def test_what_comes_together_by_the_rules_does_so_by_eye_or_by_its_second_label() -> None:
    judged = [
        (run, run.comes_together()) for part in PARTS for run in labelled_runs(part)[::EVERY]
    ]
    assert len(judged) == 14
    wrong = [
        run
        for run, together in judged
        if together not in {label == ENGAGED for label in (run.state, run.second) if label}
    ]
    assert wrong == []
