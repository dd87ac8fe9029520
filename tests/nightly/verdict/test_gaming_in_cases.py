# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
In cases of the benchmark no controller that games the judge dominates an honest one.

The cases are four of the thirty samples of each scenario, with a seed of their own.
"""

from collections.abc import Mapping
from dataclasses import replace

import pytest
from support.gaming_runs import GAMING_CONTROLLERS, HELD_OUT_SEED, gaming_file, runs_in_cases

from ddct_bringup.evaluation.case_figures import CaseFigures
from ddct_bringup.evaluation.dominance import PairedComparison, compare, dominators_of

SAMPLES = 4
HONEST = (
    'ls2',
    'ls4',
    'ls8',
    'hinf1',
    'hinf_sampled',
    'hinf_thesis',
    'torque_estimator',
    'pedal_mpc',
    'lqi',
    'least_jerk',
)
"""Controllers of the release that none of its thirty dominates in these cases."""
LIKE_LS8 = ('peek_settings', 'peek_torques', 'remember_cases', 'remember_gains')
"""Gaming controllers that find nothing in held-out cases, and so are `ls8` there."""
DOMINATED_BY_NO_LEAST = {'hinf_thesis', 'pedal_mpc'}
"""
Those that `no_least` dominates by response and peak jerk: what stays open.

It is `ls8` that requests 1 % less of the engine, and clamps the plates firmly once they lock. It
engages in 41 of the 44 cases, `ls8` in 34.
"""


@pytest.fixture(scope='module')
def honest() -> Mapping[str, CaseFigures]:
    """Return the figures of the honest controllers in the same held-out cases."""
    return {name: runs_in_cases(name, HELD_OUT_SEED, SAMPLES).figures for name in HONEST}


@pytest.fixture(scope='module')
def gaming() -> Mapping[str, CaseFigures]:
    """Return the figures of the controllers that game the judge, in those cases."""
    return {
        name: runs_in_cases(gaming_file(name), HELD_OUT_SEED, SAMPLES).figures
        for name in GAMING_CONTROLLERS
    }


def dominates(comparison: PairedComparison) -> bool:
    """Return whether the first controller dominates by the benchmark's rule, beside the honest."""
    return comparison.dominates(among=len(HONEST) + 1)


def in_response_and_peak_jerk(comparison: PairedComparison) -> PairedComparison:
    names = ('response_s', 'peak_jerk_m_s3')
    return replace(comparison, figures={name: comparison.figures[name] for name in names})


def test_no_honest_controller_dominates_another(honest: Mapping[str, CaseFigures]) -> None:
    assert not any(dominators_of(honest).values())


def test_no_gaming_controller_dominates_an_honest_one(
    honest: Mapping[str, CaseFigures], gaming: Mapping[str, CaseFigures]
) -> None:
    found = [
        (name, other)
        for name, theirs in gaming.items()
        for other, ours in honest.items()
        if dominates(compare(theirs, ours))
    ]
    assert found == []


def test_by_response_and_peak_jerk_only_no_least_dominates_more_than_ls8_does(
    honest: Mapping[str, CaseFigures], gaming: Mapping[str, CaseFigures]
) -> None:
    def dominated_by(figures: CaseFigures) -> set[str]:
        return {
            other
            for other, ours in honest.items()
            if dominates(in_response_and_peak_jerk(compare(figures, ours)))
        }

    found = {name: dominated_by(figures) for name, figures in gaming.items()}
    assert found.pop('no_least') == DOMINATED_BY_NO_LEAST
    by_ls8 = dominated_by(honest['ls8'])
    assert all(found.pop(name) <= by_ls8 for name in LIKE_LS8)
    assert not any(found.values()), found


def test_no_least_engages_more_often_than_the_controller_that_it_is_made_of(
    honest: Mapping[str, CaseFigures], gaming: Mapping[str, CaseFigures]
) -> None:
    assert gaming['no_least'].success.sum() > honest['ls8'].success.sum()
