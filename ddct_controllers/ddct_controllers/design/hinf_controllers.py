"""Our own H-infinity controllers, synthesised when they are asked for."""

from functools import lru_cache

from ddct_controllers.design.hinf_design import HinfDesign, design_h_infinity
from ddct_controllers.design.hinf_recipes import make_weights
from ddct_plant.lti import StateSpace

SYNTHESISED = {'hinf_thesis': 'thesis', 'hinf_fitted': 'fitted', 'hinf_sampled': 'sampled'}
"""Recipe of the weights by registry name; all for 8 % overshoot and 0.3 s of Section 3.2."""


@lru_cache(maxsize=len(SYNTHESISED))
def synthesised_design(name: str) -> HinfDesign:
    """Return the design behind a registry name; the same numbers in every process."""
    return design_h_infinity(make_weights(SYNTHESISED[name]))


def synthesised_controller(name: str) -> StateSpace:
    """Return G_c(z) behind a registry name, from slip error in rpm to torque in N m."""
    return synthesised_design(name).sampled
