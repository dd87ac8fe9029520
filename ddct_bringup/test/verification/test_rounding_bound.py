# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The bound of a run on another processor follows from what rounding changes in that run."""

from pathlib import Path

import pytest
from verified import RIPPLED

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.run_set import ImpossibleRow
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verification.comparison import BOUND
from ddct_bringup.verification.rounding_bound import (
    LARGEST,
    _with_other_last_bits,
    bound_of_row,
    bound_of_run,
)
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

pytestmark = pytest.mark.slow


def plan_of(place: Path, ripple_n_m: float) -> RunPlan:
    """Return the plan of a controller with a ripple of that size."""
    file = place / 'mine.py'
    file.write_text(RIPPLED.format(ripple_n_m=ripple_n_m), encoding='utf-8')
    scenario = load_scenario('thesis', {'duration_s': 2.0, 'score_window_s': [1.0, 2.0]})
    return RunPlan(RunSettings(scenario), str(file), 'headless')


@pytest.mark.parametrize(
    ('ripple_n_m', 'least', 'most'),
    [(0.0, BOUND, BOUND), (1e-6, 2.0 * BOUND, 1e-5), (10.0, LARGEST, LARGEST)],
)
def test_the_bound_follows_from_the_effect_of_the_last_bits(
    tmp_path: Path, ripple_n_m: float, least: float, most: float
) -> None:
    assert least <= bound_of_run(plan_of(tmp_path, ripple_n_m)) <= most


def test_the_inertia_is_changed_by_one_to_four_last_bits_to_both_sides() -> None:
    settings = RunSettings(load_scenario('thesis'))
    own = settings.scenario.given_driveline.engine_inertia
    changes = [
        (each.scenario.given_driveline.engine_inertia / own - 1.0) * 2.0**50
        for each in _with_other_last_bits(settings)
    ]
    assert sorted(changes) == pytest.approx([-4, -3, -2, -1, 1, 2, 3, 4], abs=0.3)


def test_a_row_has_the_bound_of_its_metrics() -> None:
    content = {
        'controllers': ['pi', 'hinf_sampled'],
        'clutch': 'stick_slip',
        'grid': {'vehicle.mass_kg': [1400.0]},
    }
    campaign = Campaign(spec_of(content, Path()))
    pi, designed = (bound_of_row(run, packaged_limits()) for run in campaign.planned(0, 2))
    assert pi == BOUND
    assert BOUND <= designed < 1e-5


def test_a_row_that_cannot_be_built_has_the_common_bound() -> None:
    # A window that ends after the run.
    grid = {'duration_s': [1.0], 'control_start_s': [2.4]}
    content = {'controllers': ['pi'], 'grid': grid}
    (row,) = Campaign(spec_of(content, Path())).planned(0, 1)
    assert isinstance(row, ImpossibleRow)
    assert bound_of_row(row, packaged_limits()) == BOUND
