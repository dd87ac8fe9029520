# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A factored transfer function as it is written as JSON."""

from typing import TypedDict

from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction


class FunctionEntry(TypedDict):
    """Gain and factors of a transfer function; a gain of G_c is in N m per rpm."""

    gain: float
    numerator: tuple[Factor, ...]
    """Factors: a number a is (s + a), a pair (b, c) is (s^2 + b s + c)."""
    denominator: tuple[Factor, ...]


def function_entry(function: FactoredTransferFunction) -> FunctionEntry:
    """Return the entry of a transfer function."""
    return {
        'gain': function.gain,
        'numerator': function.numerator,
        'denominator': function.denominator,
    }
