# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Thresholds of the states, and how a limits file gives them."""

import dataclasses
from dataclasses import dataclass, field
from typing import Any

from ddct_bringup.verdict.limits_keys import require_keys, rule_value
from ddct_plant.base.units import rad_s_from_rpm


def _rule(unit: str) -> float:
    return field(metadata={'unit': unit})


@dataclass(frozen=True)
class Rules:
    """Thresholds of the states; the file gives their reasons."""

    engaged_slip: float = _rule('rpm')
    """Magnitude of w_d in rpm below which the plates of a linear clutch count as engaged."""
    settled_time: float = _rule('s')
    """Time in s for which that slip must stay below the threshold at the end of the run."""
    locked_time: float = _rule('s')
    """Time in s for which plates must be locked at the end of the run."""
    withheld_time: float = _rule('s')
    """Largest integral of the withheld torque over the largest demand, s."""
    delivered_share: float = _rule('1')
    """Least share of the demand that is requested over the last `delivered_time`."""
    delivered_time: float = _rule('s')
    added_time: float = _rule('s')
    """Largest integral of the added torque over the largest demand, s."""
    flare_rad_s: float = _rule('rad/s')
    """Rise of w_m in rad/s above its speed in the off-going gear above which it has flared."""
    tie_up_work_j: float = _rule('J')
    """Tie-up work in J above which the clutches have tied up."""

    @property
    def engaged_slip_rad_s(self) -> float:
        """Slip in rad/s below which the plates of a linear clutch count as engaged."""
        return rad_s_from_rpm(self.engaged_slip)


def rules_of(path: str, content: Any) -> Rules:
    """Return the thresholds at `path`; raise ParameterError with the key of the first error."""
    described = dataclasses.fields(Rules)
    rules = require_keys(path, content, [each.name for each in described])
    return Rules(
        **{
            each.name: rule_value(f'{path}.{each.name}', rules[each.name], each.metadata['unit'])
            for each in described
        }
    )
