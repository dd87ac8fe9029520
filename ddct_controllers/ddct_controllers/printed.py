# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers that the thesis prints as transfer functions, in N m per rpm of slip error."""

from dataclasses import replace

from ddct_controllers.interface import Controller, ControllerContext, ControllerSpec
from ddct_controllers.linear import LinearController
from ddct_plant.base.options import Option
from ddct_plant.linear.lti import FactoredTransferFunction


def _from_g_c1(gain: float) -> FactoredTransferFunction:
    """Return G_c1 of equation (2.1), two lead networks and a lag, with another gain."""
    return FactoredTransferFunction(gain, (9.6, 1.0, 1.0), (0.0, 16.0, 16.0, 0.6))


def _from_g_c2(gain: float) -> FactoredTransferFunction:
    """Return G_c2 of equation (2.2), which cancels the driveline's zeros, with another gain."""
    return FactoredTransferFunction(gain, (0.8361, (74.29, 2393.0)), (0.0, (5.325, 339.3)))


LOOP_SHAPING_CONTROLLERS = {
    'ls1': _from_g_c1(-1.6),
    'ls2': _from_g_c1(-4.8),
    'ls3': _from_g_c1(-10.0),
    'ls4': _from_g_c2(-0.0060285),
    'ls5': _from_g_c2(-0.0072342),
    'ls6': _from_g_c2(-0.0096456),
    'ls7': _from_g_c2(-0.012057),
    'ls8': _from_g_c2(-0.014468),
    'ls9': _from_g_c2(-0.018086),
}
"""Transfer functions of Section 2.3 by registry name."""

H_INFINITY_CONTROLLERS = {
    'hinf1': FactoredTransferFunction(
        gain=-0.012266,
        numerator=(0.7567, 0.009368, (82.23, 2563.0), (121.4, 7696.0), (134.1, 4.27e4)),
        denominator=(0.0, 138.0, 89.52, 0.005905, (5.344, 339.4), (146.2, 2.914e4)),
    ),
    'hinf2': FactoredTransferFunction(
        gain=-0.48353,
        numerator=(206.6, 7.48, 0.01008, (82.23, 2563.0), (121.4, 7696.0)),
        denominator=(0.0, 303.1, 202.0, 138.0, 0.01729, (5.344, 339.4)),
    ),
    'hinf3': FactoredTransferFunction(
        gain=-0.0050214,
        numerator=(
            0.4894,
            0.006739,
            0.0002769,
            (82.23, 2563.0),
            (121.4, 7697.0),
            (134.1, 4.27e4),
        ),
        denominator=(
            138.0,
            24.42,
            0.01288,
            0.01239,
            0.005905,
            (5.344, 339.4),
            (167.4, 2.986e4),
        ),
    ),
}
"""Transfer functions of Section 3.3 by registry name."""

PRINTED_CONTROLLERS = {**LOOP_SHAPING_CONTROLLERS, **H_INFINITY_CONTROLLERS}
"""Transfer functions of all printed controllers by registry name."""


def printed_spec(name: str, g_c: FactoredTransferFunction) -> ControllerSpec[Controller]:
    """Return the specification of a printed controller; its gain is its option."""

    def make(context: ControllerContext) -> Controller:
        return LinearController(replace(g_c, gain=context.gains['gain']))

    options = {'gain': Option(g_c.gain, 'gain before the factors of the printed G_c(s)')}
    return ControllerSpec(name, make, options)
