# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Over many campaigns the attribution is wrong, and its interval covers, at the stated rate."""

import numpy as np
from made_failures import NAMES, RUNS, blamed, drawn

from ddct_bringup.campaign_report.statistics import attribution as attribution_module
from ddct_bringup.campaign_report.statistics.attribution import effects_of


def test_5_percent_of_campaigns_attribute_failures_that_no_key_causes_to_a_key(monkeypatch):
    # The intervals, which take most of the time, are drawn after all p-values and not compared.
    monkeypatch.setattr(attribution_module, '_RESAMPLES', 1)
    wrong = 0
    for seed in range(200):
        failed = np.random.default_rng([1, seed]).random(RUNS) < 0.1
        names = np.random.default_rng([4, seed]).choice(NAMES, RUNS)
        wrong += bool(blamed({**drawn(seed), 'scenario': names}, failed))
    assert wrong <= 18  # 5 % of 200 are 10; more than 18 come by chance in 0.7 % of the cases


def test_the_interval_covers_the_main_effect_in_86_of_100_campaigns():
    slope, mean = 0.4, 0.2
    true = slope**2 / 12 / (mean * (1 - mean))  # failure has the chance 0.4 (1 - wear)
    covered = 0
    for seed in range(100):
        values = drawn(seed)['wear_gain']
        failed = np.random.default_rng([2, seed]).random(RUNS) < slope * (1.0 - values)
        (wear,) = effects_of({'wear_gain': values}, failed)
        covered += wear.interval[0] <= true <= wear.interval[1]
    assert covered >= 86
