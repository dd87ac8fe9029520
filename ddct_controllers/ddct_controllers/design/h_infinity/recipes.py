# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Recipes of weights: the thesis's, those behind its Hinf1, and our own; S_p and T_p unrounded."""

from dataclasses import dataclass, replace

from ddct_controllers.design.h_infinity.synthesis.gamma_iteration import BACK_OFF
from ddct_controllers.design.h_infinity.weights import (
    ComplementaryWeight,
    EffortWeight,
    SensitivityWeight,
)
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_plant.base.errors import ParameterError, require_choice

THESIS_SPECIFICATIONS = TimeSpecifications(rise_time_s=0.3, overshoot=0.08)
"""Time specifications of Section 3.2."""


@dataclass(frozen=True)
class HinfWeights:
    """Weights of one design."""

    sensitivity: SensitivityWeight
    complementary: ComplementaryWeight
    effort: EffortWeight | None
    sampled: bool
    """Whether the design plant has hold and delay."""
    back_off: float
    """Level of the controller over the optimum; 1 where the thesis too stopped and cleaned."""


NEAR_OPTIMUM = 1.0002
"""
Level, over the optimum, at which the fastest pole is still so fast that it is cleaned.

At the optimum itself a controller has 7 digits, and would be another one on each processor.
"""
_THESIS = HinfWeights(
    SensitivityWeight(low_frequency_gain=0.15, peak=THESIS_SPECIFICATIONS.sensitivity_peak),
    ComplementaryWeight(peak=THESIS_SPECIFICATIONS.complementary_peak, corner_rad_s=28.0),
    effort=None,
    sampled=False,
    back_off=BACK_OFF,
)
RECIPES = {
    'thesis': _THESIS,
    'fitted': replace(
        _THESIS,
        sensitivity=replace(_THESIS.sensitivity, low_frequency_gain=0.35),
        complementary=replace(_THESIS.complementary, damping=1.0),
        back_off=NEAR_OPTIMUM,
    ),
    'sampled': replace(
        _THESIS,
        effort=EffortWeight(torque_n_m_per_rpm=0.055, corner_rad_s=30.0),
        sampled=True,
    ),
}
"""
Weights by the name of the option --weights, for the specifications of Section 3.2.

- `thesis`: the weights of Section 3.2.1, with K and w_2 as printed.
- `fitted`: weights that lead to nearly the printed Hinf1.
- `sampled`: those of `thesis` with one more on the torque, for a plant with hold and delay.
"""
PRINTED_WEIGHTS = HinfWeights(
    SensitivityWeight(low_frequency_gain=0.15, peak=1.33),
    ComplementaryWeight(peak=1.02, corner_rad_s=28.0),
    effort=None,
    sampled=False,
    back_off=1.0,
)
"""Weights of Section 3.2.1: K, S_p, T_p and w_2 as printed; at the optimum, as the thesis's."""


def make_weights(
    recipe: str,
    specifications: TimeSpecifications = THESIS_SPECIFICATIONS,
    low_frequency_gain: float | None = None,
    bandwidth_rad_s: float | None = None,
    effort_n_m_per_rpm: float | None = None,
    back_off: float | None = None,
) -> HinfWeights:
    """
    Return the weights of a recipe for specifications; arguments override the recipe.

    S_p and T_p follow from the overshoot. K and w_2 are the designer's choice in the thesis; with
    the rise time, times grow by a factor t_r / 0.3 s, so that K grows by its square.
    """
    require_choice('weights', recipe, tuple(RECIPES))
    chosen = RECIPES[recipe]
    slower = specifications.rise_time_s / THESIS_SPECIFICATIONS.rise_time_s
    sensitivity, complementary = chosen.sensitivity, chosen.complementary
    return replace(
        chosen,
        sensitivity=SensitivityWeight(
            _either(low_frequency_gain, sensitivity.low_frequency_gain * slower**2),
            specifications.sensitivity_peak,
        ),
        complementary=ComplementaryWeight(
            specifications.complementary_peak,
            _either(bandwidth_rad_s, complementary.corner_rad_s / slower),
            complementary.damping,
        ),
        effort=_effort(chosen.effort, effort_n_m_per_rpm, slower),
        back_off=_either(back_off, chosen.back_off),
    )


def _either(given: float | None, otherwise: float) -> float:
    return otherwise if given is None else given


def _effort(
    recipe: EffortWeight | None, torque: float | None, slower: float
) -> EffortWeight | None:
    """Return the weight on the torque; `torque` replaces that of the recipe where it is given."""
    if recipe is None:
        if torque is not None:
            raise ParameterError('only the sampled design weighs the torque: leave out its weight')
        return None
    return EffortWeight(
        _either(torque, recipe.torque_n_m_per_rpm / slower), recipe.corner_rad_s / slower
    )
