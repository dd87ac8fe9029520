# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Findings of Section 3.2 that choose between two readings of the thesis."""

import dataclasses
import math

from ddct_bringup.reproduction.values import h_infinity_values as module


def test_the_formula_of_the_rise_time_is_the_one_that_gives_the_printed_frequency(monkeypatch):
    assert module._rise_formula() == 'pi - arccos(zeta)'
    angle = math.acos(module.THESIS_SPECIFICATIONS.damping)
    other = math.pi * angle / (9.6 * math.sin(angle))
    specifications = dataclasses.replace(module.THESIS_SPECIFICATIONS, rise_time_s=other)
    monkeypatch.setattr(module, 'THESIS_SPECIFICATIONS', specifications)
    assert module._rise_formula() == 'pi arccos(zeta)'


def test_two_calls_of_sderiv_make_a_weight_with_damping_one_and_not_the_printed_one(monkeypatch):
    assert module._synthesised_weight() == '(1 + s/w_2)^2/T_p'
    complementary = dataclasses.replace(module.PRINTED_WEIGHTS.complementary, damping=1.0)
    weights = dataclasses.replace(module.PRINTED_WEIGHTS, complementary=complementary)
    monkeypatch.setattr(module, 'PRINTED_WEIGHTS', weights)
    assert module._synthesised_weight() == 'W_t(s)'
