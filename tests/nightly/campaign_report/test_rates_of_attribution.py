# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Over many campaigns the attribution is wrong, and its interval covers, at the stated rate."""

from made_failures import covered_effects, wrongly_blamed

from ddct_bringup.evaluation import attribution as attribution_module


def test_5_percent_of_campaigns_attribute_failures_that_no_key_causes_to_a_key(monkeypatch):
    # The intervals, which take most of the time, are drawn after all p-values and not compared.
    monkeypatch.setattr(attribution_module, '_RESAMPLES', 1)
    assert (
        wrongly_blamed(200) <= 18
    )  # 5 % of 200 are 10; more than 18 come by chance in 0.7 % of the cases


def test_the_interval_covers_the_main_effect_in_86_of_100_campaigns():
    assert covered_effects(100) >= 86
