# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Checks in the closed loop: time, rate, unit, linear model, stability."""

import numpy as np

from ddct_controllers.check.subject import CheckFailedError, CheckSkippedError, Subject
from ddct_controllers.check.trial import closed_trial, step_response
from ddct_controllers.linear import DiscreteFilter
from ddct_controllers.places import place_of_method
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import RAD_S_PER_RPM, RPM_PER_RAD_S
from ddct_plant.linear.lti import StateSpace

LATE_SHARE = 0.05
"""Share of updates that may take longer than their period, without unit."""
AGAIN = 2
"""Number of further runs of a controller that seems slow."""
MOST_STROKES_PER_S = 10.0
"""
Largest mean rate of the request, in full strokes of the clutch's capacity per second.

It is for the bandwidth of the printed actuator, and in proportion to that of another one.
"""
HALF = 0.5
"""Least share of a reference step followed within 1 s; with less an engagement takes too long."""
WELL = 0.8
"""Share of a reference step that a well tuned loop follows within 1 s."""


def update_time(subject: Subject) -> str:
    """
    Check that an update takes less than its period.

    Another process can occupy the machine for as long. So where a controller seems slow, each
    update counts with the least time of three runs.
    """
    least = np.array(subject.closed_loop.update_s)
    for _ in range(AGAIN):
        if _slowest(least) < PERIOD_S and not subject.closed_loop.too_slow:
            break
        subject.closed_loop = closed_trial(subject.settings, subject.make())
        updates = min(len(least), len(subject.closed_loop.update_s))
        least = np.minimum(least[:updates], subject.closed_loop.update_s[:updates])
    slowest = _slowest(least)
    found = (
        f'median {1e3 * np.median(least):.3f} ms, {1.0 - LATE_SHARE:.0%} within '
        f'{1e3 * slowest:.3f} ms, of {len(least)} updates'
    )
    if slowest >= PERIOD_S or subject.closed_loop.too_slow:
        raise CheckFailedError(
            f'{found}: it must be done within its period of {1e3 * PERIOD_S:g} ms; compute what '
            'does not change in __init__, not in update '
            f'({place_of_method(subject.sample, "update")})'
        )
    return found


def _slowest(times_s: np.ndarray) -> float:
    """Return the time in s within which all but LATE_SHARE of the updates are done."""
    return float(np.quantile(times_s, 1.0 - LATE_SHARE))


def rate(subject: Subject) -> str:
    """Check that the request does not chatter."""
    scenario = subject.settings.scenario
    start = scenario.control_start_step
    strokes_per_s = MOST_STROKES_PER_S * scenario.actuator.bandwidth_factor
    most = strokes_per_s * scenario.friction.most_n_m
    changes = np.abs(np.diff(subject.closed_loop.request[start:]))
    per_second = float(changes.mean()) / PERIOD_S
    found = (
        f'the request moves by {changes.max():.4g} N m per period at most, {per_second:.4g} N m '
        'per second'
    )
    if per_second > most:
        raise CheckFailedError(
            f'{found}, more than {most:g}: the actuator does not follow that, and the '
            f'driveline rings; smooth it in {place_of_method(subject.sample, "update")}'
        )
    return found


def unit(subject: Subject) -> str:
    """Check that no factor 30/pi makes the difference between a bad loop and a good one."""
    response = subject.response
    found = f'a step of the reference is followed to {response.followed:.0%} after 1 s'
    if response.diverges:
        found, what, factor = 'the loop is unstable', 'smaller', RAD_S_PER_RPM
    elif response.followed < HALF:
        what, factor = 'larger', RPM_PER_RAD_S
    else:
        return found
    other = step_response(subject.settings, subject.make, factor)
    if other.diverges or other.followed < WELL:
        return f'{found}; a torque 9.55 times {what} is no better: the unit is not the cause'
    raise CheckFailedError(
        f'{found}; with a torque 9.55 times {what} the loop is stable and follows to '
        f'{other.followed:.0%}. That is 30/pi, rpm in a rad/s: look at the units in '
        f'{place_of_method(subject.sample, "update")}; slip_error_rpm is in rpm, the speeds and '
        'slip_reference are in rad/s. If they are right, change the gain'
    )


def stability(subject: Subject) -> str:
    """Check that the loop settles: in a run, and by its poles if the controller is linear."""
    if subject.response.diverges:
        raise CheckFailedError(
            'in the closed loop the slip ends further from its reference than control found it, '
            'or the answer to a step of the reference grows: check sign, unit and the '
            f'{PERIOD_S:g} s of a step in sums, then lower the gain '
            f'({place_of_method(subject.sample, "update")})'
        )
    model = _linear_model(subject)
    if model is None:
        return 'the run settles, and so does a step of the reference; no linear_model'
    # Only here: the mathematics of design takes a moment to load.
    from ddct_controllers.design.analysis.loops import sampled_loop
    from ddct_controllers.design.analysis.margins import loop_margins

    scenario = subject.settings.scenario
    margins = loop_margins(sampled_loop(model, scenario.driveline, actuator=scenario.actuator))
    if not margins.stable:
        raise CheckFailedError(
            'the sampled loop of its linear_model has a pole on or outside the unit circle: lower '
            'the gain (design margins has the margins)'
        )
    return (
        f'all poles of the sampled loop are inside the unit circle; gain margin '
        f'{margins.gain_margin_db:.1f} dB, phase margin {margins.phase_margin_deg:.0f} deg'
    )


def linear_model(subject: Subject) -> str:
    """Check that update computes the output of linear_model."""
    model = _linear_model(subject)
    if model is None:
        raise CheckSkippedError('linear_model returns None')
    filtered = DiscreteFilter(model)
    worst = 0.0
    for (on, measurement), (torque, _) in zip(subject.measurements, subject.torques, strict=True):
        if on:
            expected = filtered.update(measurement.slip_error_rpm)
            worst = max(worst, abs(torque - expected))
    largest = float(np.abs(subject.torques[:, 0]).max())
    if worst > 1e-6 * max(largest, 1.0):
        raise CheckFailedError(
            f'its torque and that of its linear_model differ by up to {worst:.4g} of '
            f'{largest:.4g} N m: mend {place_of_method(subject.sample, "linear_model")}, '
            'or return None'
        )
    return f'update gives the torque of linear_model within {worst:.1g} N m'


def _linear_model(subject: Subject) -> StateSpace | None:
    controller = subject.sample
    model = controller.linear_model()
    if model is None:
        return None
    if not isinstance(model, StateSpace) or model.d.shape != (1, 1) or model.period_s != PERIOD_S:
        raise CheckFailedError(
            f'linear_model gives {type(model).__name__}, and not a StateSpace with one input, one '
            f'output and a period of {PERIOD_S} s: mend '
            f'{place_of_method(controller, "linear_model")}'
        )
    return model
