# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What counts in a benchmark, which tricks gain nothing, and which stay possible."""

from collections.abc import Mapping

from ddct_bringup.evaluation.case_figures import FIGURES
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.rules import Rules
from ddct_plant.program.table import PURE


def states_that_count(rules: Rules) -> Mapping[str, str]:
    """Return what the states mean, with the thresholds of a limits file."""
    return {
        'engaged': 'None of the following: the only success. A linear clutch, which cannot lock, '
        f'slips by at most {rules.engaged_slip:g} rpm over the last {rules.settled_time:g} s.',
        'not engaged': 'The plates are not locked at the end.',
        'late': f'They are locked at the end, but for less than {rules.locked_time:g} s.',
        'withheld': 'The controller commands the engine, and takes more than '
        f"{rules.withheld_time:g} s of the driver's largest demand away, or requests less than "
        f'{100.0 * rules.delivered_share:g} % of the demand over the last '
        f'{rules.delivered_time:g} s.',
        'added': 'The controller commands the engine, and adds more than '
        f'{rules.added_time:g} s of the largest demand.',
        'stalled, over revved': 'The engine left its limits, which ends the run.',
        'tied up': 'The clutches of a gear shift do more than '
        f'{rules.tie_up_work_j:g} J against each other.',
        'flared': 'The engine rises between the gears of a shift by more than '
        f'{rules.flare_rad_s:g} rad/s.',
        'invalid': 'The run does not count as any other state, as where the controller fails.',
    }


def figures_that_count() -> Mapping[str, str]:
    """Return what the five figures mean, by symbol and unit; of each less is better."""
    return {
        each.quantity.symbol
        + ('' if each.quantity.unit == PURE else f', {each.quantity.unit}'): each.quantity.meaning
        for each in FIGURES
    }


NO_GAIN = (
    'to take torque away beyond the threshold, or to add it: the run is withheld or added, a '
    'failure',
    'to take it away below the threshold: the response has every second of it',
    'to lock late, or to slam at the end: every figure counts to the end of the run, and the '
    'response has the time of the lock',
    'to slip on, or to open again: not engaged, or releases',
    'to fail in hard cases: in dominance and gaps a failure is worse than any success, and its '
    'share stands beside the figures of the successes',
    'to remember the development cases: the gap to held-out cases shows it',
)
"""What a controller cannot gain by."""


def left_open(rules: Rules) -> str:
    """Return the sentence on what stays open to gaming, with the thresholds of a limits file."""
    return (
        f'What stays open to gaming: up to {rules.withheld_time:g} s of the largest demand '
        f'withheld, which the response has second for second, or {rules.added_time:g} s added; '
        'torque that is paid back later is free; the sign test ignores how large a difference '
        'is, which P95 and worst show; a comment can be changed until the held-out seed is kind, '
        'so that a judge gives his own; a controller that only fails half as often in the '
        'development cases, since it remembers them, in 5 % for 10 %, is found in half of the '
        'draws alone.'
    )


def left_open_here() -> str:
    """Return the sentence on what stays open with the packaged limits, which judge."""
    return left_open(packaged_limits().rules)
