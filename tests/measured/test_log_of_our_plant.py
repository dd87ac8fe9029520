# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A fit to an exact log of our own plant finds its driveline."""

from pathlib import Path

import pytest
from support.runs import plan, record

from ddct_plant.identification.from_log.command import NEEDED
from ddct_plant.identification.from_log.fit import fit_log
from ddct_plant.identification.from_log.scenario import load_of
from ddct_plant.measured.columns import TIME, own_columns
from ddct_plant.measured.log import read_log
from ddct_plant.scenario.file import load_scenario


@pytest.mark.parametrize('controller', ['pi', 'ls8'])
def test_all_eight_parameters_of_an_exact_log_are_in_their_intervals(
    tmp_path: Path, controller: str
) -> None:
    """
    The plant holds C_load over 10 ms. As linear it moves c_prim by 69 half-widths of its interval.

    A twentieth of the intervals miss by chance, and what is left is the rounding of the log.
    """
    record(plan(controller, 'headless', duration_s=3.0), tmp_path / controller)
    log = read_log(tmp_path / controller, own_columns(TIME, *NEEDED), NEEDED)
    thesis = load_scenario('thesis')
    fit = fit_log(log, thesis.driveline, load_of(thesis))
    misses = 0
    for name, true in thesis.driveline.values().items():
        lowest, highest = fit.interval(name) or (1.0, -1.0)
        half = 0.5 * (highest - lowest)
        assert 0.0 < half < 1e-8 * max(true, 0.01), name
        assert abs(fit.values[name] - true) < 2.5 * half, name
        misses += not lowest <= true <= highest
    assert misses <= 1
