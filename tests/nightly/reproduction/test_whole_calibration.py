# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The search over score windows and starts finds the packaged scenario `thesis` again."""

import pytest

from calibrate.__main__ import require_packaged
from calibrate.problem import Problem, values_of
from calibrate.search import STARTS, fit, lowest_stable, window_ends
from ddct_plant.scenario.file import load_scenario

SCENARIO = load_scenario('thesis')
END_S = SCENARIO.score_window_s[1]
PACKAGED = Problem(SCENARIO, END_S).residuals(values_of(SCENARIO))
OBJECTIVE = 0.5 * float(PACKAGED @ PACKAGED)


@pytest.mark.parametrize('end_s', [end for end in window_ends(SCENARIO) if end != END_S])
def test_another_end_of_the_score_window_fits_worse(end_s: float) -> None:
    fits = [fit(Problem(SCENARIO, end_s), start) for start in STARTS[:2]]
    assert lowest_stable(fits).objective > 1.05 * OBJECTIVE


def test_the_best_fit_of_all_starts_is_the_packaged_scenario() -> None:
    fits = [fit(Problem(SCENARIO, END_S), start) for start in STARTS]
    require_packaged(lowest_stable(fits), SCENARIO)
