# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Checks with extraordinary measurements, and of the signals that a controller reacts to."""

import math
from dataclasses import replace

import numpy as np

from ddct_controllers.check.subject import CheckFailedError, CheckSkippedError, Subject
from ddct_controllers.check.trial import PROBE_RAD_S, PROBE_RPM, more_slip, probe_step, replay
from ddct_controllers.interface import Measurement
from ddct_controllers.places import place_of_method
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S

SPIKE_RAD_S = 200.0
"""Additional slip in rad/s for one period."""
LASTING_RAD_S = 300.0
"""Additional slip in rad/s over half a second, more than any clutch torque can reduce."""
SETTLED_N_M = 1.0
"""Largest change of the torque in N m that may be left at the end after one NaN."""
WITHIN_STEPS = 30
"""Number of periods within which a controller must have reacted to slip."""


def not_a_number(subject: Subject) -> str:
    """Check that a measurement of NaN is refused, ends the run, or is left out: never hidden."""
    controller = subject.make()
    first = probe_step(subject.settings)
    try:
        after = replay(controller, subject.measurements, _without_number, first, first + 1)
    except DdctError as error:
        found = f'it refuses NaN: {error}'
    else:
        found = _after_nan(subject, after - subject.torques)
    controller.reset()
    if not np.array_equal(replay(controller, subject.measurements), subject.torques):
        raise CheckFailedError(
            'after a measurement of NaN and a reset it does not answer as a new object: set '
            f'all state anew in {place_of_method(controller, "reset")}'
        )
    return found


def _after_nan(subject: Subject, change: np.ndarray) -> str:
    if not np.isfinite(change).all():
        return 'NaN leads to a torque of NaN, which ends the run with one line'
    if (left := float(np.abs(change[-1]).max())) > SETTLED_N_M:
        raise CheckFailedError(
            f'one engine speed of NaN goes unnoticed and moves its torque by {left:.4g} N m '
            f'for good: limits such as min(max(x, ...)) hide NaN; raise an error or leave such a '
            f'measurement out, in {place_of_method(subject.sample, "update")}'
        )
    return 'NaN is left out'


def spike(subject: Subject) -> str:
    """Check that the torques stay finite after a spike in one measured speed."""
    torques = subject.replay(lambda m: more_slip(m, SPIKE_RAD_S), steps=1)
    change = _finite(subject, torques, f'a spike of {SPIKE_RAD_S:g} rad/s in the engine speed')
    return (
        f'a spike of {SPIKE_RAD_S:g} rad/s moves the torque by up to {np.abs(change).max():.4g} '
        f'N m, {np.abs(change[-1]).max():.4g} N m in the end'
    )


def saturation(subject: Subject) -> str:
    """Check that the torques stay finite under slip that no torque reduces."""
    torques = subject.replay(lambda m: more_slip(m, LASTING_RAD_S), steps=round(0.5 / PERIOD_S))
    change = _finite(subject, torques, f'{LASTING_RAD_S:g} rad/s more slip over 0.5 s')
    most = float(np.abs(change).max())
    return (
        f'{LASTING_RAD_S:g} rad/s more slip over 0.5 s asks up to {most:.4g} N m more; 0.5 s '
        f'later {np.abs(change[-1]).max():.4g} N m of it are left (no limit: much of it is an '
        'integral that grew, which limits in update prevent)'
    )


def _finite(subject: Subject, torques: np.ndarray, what: str) -> np.ndarray:
    """Return the torques' change, (steps, 2), in N m; CheckFailedError unless finite."""
    if not np.isfinite(torques).all():
        raise CheckFailedError(
            f'{what} makes the torque infinite or NaN: limit what grows in '
            f'{place_of_method(subject.sample, "update")}'
        )
    return torques - subject.torques


def preview(subject: Subject) -> str:
    """Check that a controller that declares preview steps uses the reference ahead."""
    steps = subject.sample.preview_steps
    if not steps:
        raise CheckSkippedError('it declares no preview_steps')
    changed = subject.replay(_other_future)
    if np.array_equal(changed, subject.torques):
        raise CheckFailedError(
            f'it declares preview_steps = {steps}, but a reference that differs from the next '
            'step on changes no torque: use slip_reference[1:], or leave preview_steps out'
        )
    most = np.abs(changed - subject.torques).max()
    return (
        f'{steps} steps; a reference that differs from the next step on moves the torque by '
        f'{most:.4g} N m'
    )


def sign(subject: Subject) -> str:
    """Check that more slip raises the request to the clutch, or lowers that to the engine."""
    change = subject.replay(more_slip) - subject.torques
    first = probe_step(subject.settings)
    clutch, engine = change[first : first + WITHIN_STEPS].mean(axis=0)
    found = f'{PROBE_RPM:g} rpm more slip changes the clutch torque by {clutch:+.4g} N m'
    if subject.sample.commands_engine:
        found += f' and the engine torque by {engine:+.4g} N m'
    found += f', mean over {WITHIN_STEPS * PERIOD_S:g} s'
    if clutch == 0.0 and engine == 0.0:
        raise CheckSkippedError(f'{found}: it does not react to slip')
    if clutch - engine < 0.0:
        raise CheckFailedError(
            f'{found}, which drives the slip further up: change the sign in '
            f'{place_of_method(subject.sample, "update")}; the error is reference less slip, so a '
            'positive error asks for less torque: -gain * slip_error_rpm'
        )
    return found


def _without_number(measurement: Measurement) -> Measurement:
    return replace(measurement, engine_speed=math.nan)


def _other_future(measurement: Measurement) -> Measurement:
    now, *ahead = measurement.slip_reference
    return replace(measurement, slip_reference=[now, *(each + PROBE_RAD_S for each in ahead)])
