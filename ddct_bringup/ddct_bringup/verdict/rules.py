# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rules of the states: their thresholds, and how a limits file gives them."""

import dataclasses
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from typing import Any, TypeVar

from ddct_bringup.verdict.limits_keys import require_keys, rule_value
from ddct_plant.files.yaml_text import parse_yaml


def _rule(unit: str, at_least: float | None = None) -> float:
    return field(metadata={'unit': unit, 'at_least': at_least})


@dataclass(frozen=True)
class Rules:
    """Thresholds of the states, and assumptions of the criteria; the file gives the reasons."""

    engaged_slip: float = _rule('rpm')
    """Magnitude of w_d in rpm below which the plates of a linear clutch count as engaged."""
    locked_slip: float = _rule('rpm')
    """Magnitude of w_d in rpm below which a stick-slip clutch without a lock is nearly engaged."""
    settled_time: float = _rule('s')
    """Time in s for which the slip must stay below the threshold at the end of the run."""
    oscillation_turns: float = _rule('1', at_least=3.0)
    """
    Number of turns of the slip after control start that make an oscillation; 3 are one cycle.
    """
    runaway_slip: float = _rule('rpm')
    """Magnitude of w_d in rpm above which the plates have been driven apart."""
    runaway_growth: float = _rule('rpm/s')
    """Growth rate of |w_d| in rpm/s at the end above which the plates are being driven apart."""
    runaway_swing: float = _rule('1', at_least=1.0)
    """Ratio of the last swing to the largest earlier one at which oscillations diverge."""
    engagements_a_day: float = _rule('1')
    """Number of engagements per day, for the daily vibration dose."""


@dataclass(frozen=True)
class ShiftRules:
    """Thresholds of the states of a gear shift; the file gives the reasons."""

    flare: float = _rule('rad/s')
    """Rise of w_m in rad/s above its speed in the off-going gear above which it has flared."""
    tie_up_work: float = _rule('J')
    """Tie-up work in J above which the clutches have tied up."""


_Thresholds = TypeVar('_Thresholds', Rules, ShiftRules)


@cache
def packaged_shift_rules() -> ShiftRules:
    """Return the thresholds of a gear shift of the package."""
    # They are in a file of their own, so that the digest of the limits of other runs stays.
    file = files('ddct_bringup.verdict') / 'shift_rules.yaml'
    return thresholds_of(
        ShiftRules, 'shift', parse_yaml(file.read_text(encoding='utf-8'))['shift']
    )


def thresholds_of(kind: type[_Thresholds], path: str, content: Any) -> _Thresholds:
    """Return the thresholds at `path`; raise ParameterError with the key of the first error."""
    described = dataclasses.fields(kind)
    rules = require_keys(path, content, [each.name for each in described])
    return kind(
        **{
            each.name: rule_value(f'{path}.{each.name}', rules[each.name], **each.metadata)
            for each in described
        }
    )
