"""
The words of Table 5.2, as far as they can be judged.

The thesis names no limits. What is fixed here is the order that the words imply, and one limit
for `good`.
"""

import math
from collections.abc import Mapping

from ddct_bringup.scores.metrics import Metrics

GOOD_SLIP_RAD_S = 3.0
"""
Below this slip speed at the end of the score window w_d is `good`.

Hinf2 ends at 0.6 rad/s at most, LS8 at 23 rad/s at least.
"""
BAD_SLIP = ('ls8', 'mpc3')
"""Controllers whose w_d the thesis calls `bad`: `average` is better than both and not good."""
LOW_AND_HIGH = ('hinf2', 'ls8')
"""Controllers whose w_sr and A_x it calls `low` and `high`: `average` is between the two."""


def slip_word(name: str, slips: Mapping[str, float]) -> str:
    """Return good, average or bad for `name`; `slips` are |w_d| in rad/s at the end, by name."""
    if slips[name] < GOOD_SLIP_RAD_S:
        return 'good'
    return 'bad' if slips[name] >= min(slips[bad] for bad in BAD_SLIP) else 'average'


def oscillation_word(name: str, metrics: Mapping[str, Metrics]) -> str:
    """Return low, average or high; where w_sr and A_x differ, both words."""
    torsion = {other: found.torsion_speed_std_rpm for other, found in metrics.items()}
    acceleration = {other: found.acceleration_std_m_s2 for other, found in metrics.items()}
    words = [_level(name, torsion), _level(name, acceleration)]
    return words[0] if words[0] == words[1] else ', '.join(words)


def _level(name: str, sigmas: Mapping[str, float | None]) -> str:
    """Return where a sigma is beside those of Hinf2 and LS8, of which it may be one."""
    # One that does not exist, as of a run that grows beyond all numbers, is the highest.
    known = {other: math.inf if sigma is None else sigma for other, sigma in sigmas.items()}
    least, most = sorted(known[other] for other in LOW_AND_HIGH)
    if known[name] <= least:
        return 'low'
    return 'high' if known[name] >= most else 'average'
