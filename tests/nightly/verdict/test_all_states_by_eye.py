# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The rules agree with judgement by eye on runs that they were not written for."""

from dataclasses import replace

import pytest
from labelled_runs import labelled_runs

from ddct_bringup.verdict.state import ENGAGED

PARTS = ('development', 'first_check', 'held_out', 'rev_limiter')


@pytest.mark.filterwarnings('ignore::RuntimeWarning')  # a slip of 1e6 rpm
@pytest.mark.parametrize('part', PARTS)
def test_what_comes_together_by_the_rules_does_so_by_eye(part):
    runs = labelled_runs(part)
    wrong = [
        run
        for run in runs
        for together in [run.comes_together()]
        if together not in {label == ENGAGED for label in (run.state, run.second) if label}
    ]
    assert len(wrong) <= 0.08 * len(runs), (
        wrong
    )  # short runs that lock in their last .5 s are late


def test_no_run_is_in_two_parts():
    settings = [
        replace(run, state='', second=None) for part in PARTS for run in labelled_runs(part)
    ]
    assert len(settings) == len(set(settings))
