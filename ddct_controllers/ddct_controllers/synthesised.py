"""Our own H-infinity controllers, synthesised when they are asked for."""

from functools import lru_cache
from typing import TYPE_CHECKING

from ddct_plant.linear.lti import StateSpace

if TYPE_CHECKING:
    from ddct_controllers.design.h_infinity.design import HinfDesign

SYNTHESISED = {'hinf_thesis': 'thesis', 'hinf_fitted': 'fitted', 'hinf_sampled': 'sampled'}
"""Recipe of the weights by registry name; all for 8 % overshoot and 0.3 s of Section 3.2."""


@lru_cache(maxsize=len(SYNTHESISED))
def synthesised_design(name: str) -> 'HinfDesign':
    """Return the design behind a registry name; the same numbers in every process."""
    # Only here: who runs another controller need not wait for the imports of the synthesis.
    from ddct_controllers.design.h_infinity.design import design_h_infinity
    from ddct_controllers.design.h_infinity.recipes import make_weights

    return design_h_infinity(make_weights(SYNTHESISED[name]))


def synthesised_controller(name: str) -> StateSpace:
    """Return G_c(z) behind a registry name, from slip error in rpm to torque in N m."""
    return synthesised_design(name).sampled
