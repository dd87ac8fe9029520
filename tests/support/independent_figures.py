# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Every figure of a run from its bag, by numpy and scipy alone, from the definitions on the pages.

    python tests/support/independent_figures.py runs/mine/pi runs/mine/ls8

It prints the figures of each bag as one line of JSON. No code of ours is imported, so that a test
can compare them with those of `scores.json`.

All run from control start (of a gear shift: from its start) to the end of the run. Torques act for
one period each, so the integral of one is the sum over its periods.
"""

import json
import math
import sys
from pathlib import Path

import numpy as np
import scipy

if __name__ == '__main__':
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from support.independent_bag import LOCK, PERIOD_S, RELEASE, IndependentBag

RATE_HZ = 1.0 / PERIOD_S
LEAST_SLIP_RAD_S = 50.0 * math.pi / 30.0
"""Least slip at the start of feedback for which the least friction work has a ratio."""
AT_END_S = 0.3
"""Last part of a run in which the delivered share of the demand counts."""
GEARBOX = {
    'ratios': (3.9, 2.269, 1.435, 0.978, 0.755, 0.622),
    'final_drives': (4.118,) * 6,
    'measured_gears': (2,),
    'measured_ratios': (9.3416024,),
}
"""Gearbox of a car that does not give its own."""
Figure = float | int | None


def independent_figures(bag: Path) -> dict[str, Figure]:
    """
    Return the figures of a run by their keys in `scores.json`; None where one has no value.

    `withheld_s`, `added_s` and `delivered_at_end` decide the states of that name.
    """
    run = IndependentBag.read(bag)
    found: dict[str, Figure] = {
        'time_to_final_lock_s': time_to_final_lock(run),
        'torque_late_s': torque_late(run),
        'peak_jerk_m_s3': peak_jerk(run) if run.steps == run.planned_steps else None,
        'friction_work_j': friction_work(run, run.start),
        'weighted_acceleration_m_s2': running_weighted(run, run.start, 1.0),
        'releases': releases(run),
        'friction_work_over_least': work_over_least(run),
        **(of_shift(run) if run.shift else {}),
        **of_commands(run),
    }
    # Values that cannot be computed, such as those of a run that diverged, are no figures.
    return {
        key: value if value is not None and math.isfinite(value) else None
        for key, value in found.items()
    }


def time_to_final_lock(run: IndependentBag) -> float | None:
    """Return the time in s to the last lock; 0 if the plates have not parted since the start."""
    if not run.sticks or run.of_phase('phase')[-1] != 'locked':
        return None
    locks = [event.time_s for event in run.events() if event.kind == LOCK]
    return max(locks[-1] - run.start * PERIOD_S, 0.0) if locks else 0.0


def releases(run: IndependentBag) -> int | None:
    """Return how often the plates part after control start."""
    if not run.sticks:
        return None
    return sum(event.kind == RELEASE and event.step > run.start for event in run.events())


def _per_demand(run: IndependentBag, torque: np.ndarray) -> float | None:
    """Return the integral of a torque, (N+1,), over the largest demand, in s."""
    demand = run.torque('/engine/torque_demand')[run.start : -1]
    if not demand.size or np.min(demand) < 0.0 or np.max(demand) <= 0.0:
        return None
    return float(np.sum(torque[run.start : -1]) * PERIOD_S / np.max(demand))


def torque_late(run: IndependentBag) -> float | None:
    """Return the time in s by which the delivered torque is behind the driver's demand."""
    missing = run.torque('/engine/torque_demand') - run.torque('/engine/torque')
    return _per_demand(run, np.maximum(missing, 0.0))


def of_commands(run: IndependentBag) -> dict[str, Figure]:
    """
    Return what a controller that commands the engine withholds and adds; None for others.

    The cut of a handover comes off the demand: it is not the controller's. Nothing is withheld
    that the engine gives, and nothing added that it does not give.
    """
    keys = ('withheld_s', 'added_s', 'delivered_at_end')
    if not run.commands_engine:
        return dict.fromkeys(keys)
    demand, request = run.torque('/engine/torque_demand'), run.torque('/engine/torque_request')
    delivered = run.torque('/engine/torque')
    cut = run.torque('/engine/torque_cut') if run.shift else np.zeros_like(demand)
    last = slice(-1 - round(AT_END_S / PERIOD_S), -1)
    wanted, given = demand - cut, np.maximum(delivered, request)
    at_end = np.sum(wanted[last])
    values = (
        _per_demand(run, np.maximum(wanted - given, 0.0)),
        _per_demand(run, np.maximum(np.minimum(delivered, request) - demand, 0.0)),
        float(np.sum(np.minimum(given, wanted)[last]) / at_end) if at_end > 0.0 else None,
    )
    return dict(zip(keys, values, strict=True))


def peak_jerk(run: IndependentBag) -> float:
    """
    Return the largest magnitude of the jerk in m/s^3.

    A_x passes a Butterworth low-pass of second order at 20 Hz forward and backward, extended by
    nine samples at both ends of the run, point-symmetric about its end values.
    """
    low_pass = scipy.signal.butter(2, 20.0, fs=RATE_HZ)
    smooth = scipy.signal.filtfilt(*low_pass, run.acceleration, padtype='odd', padlen=9)
    return float(np.max(np.abs(np.diff(smooth)[run.start :])) / PERIOD_S)


def weighting() -> np.ndarray:
    """
    Return W_d of ISO 2631-1 at 100 Hz as second-order sections, by the bilinear transformation.

    A high-pass at 0.4 Hz with Q = 1/sqrt(2), and (1 + s/w)/(1 + s/(Q w) + (s/w)^2) with
    w = 2 pi 2 rad/s and Q = 0.63.
    """
    high, w, q = 2.0 * math.pi * 0.4, 2.0 * math.pi * 2.0, 0.63
    analogue = (
        ([1.0, 0.0, 0.0], [1.0, high * math.sqrt(2.0), high**2]),
        ([1.0 / w, 1.0], [1.0 / w**2, 1.0 / (q * w), 1.0]),
    )
    sections = []
    for numerator, denominator in analogue:
        b, a = scipy.signal.bilinear(numerator, denominator, fs=RATE_HZ)
        sections.append([*b, *a])
    return np.array(sections)


def running_weighted(run: IndependentBag, start: int, seconds: float) -> float | None:
    """
    Return the largest r.m.s. in m/s^2 of the weighted A_x over any such time after `start`.

    The filter starts with the run, in steady state. None for a shorter run.
    """
    samples = round(seconds / PERIOD_S)
    if run.steps - start < samples:
        return None
    sections = weighting()
    states = scipy.signal.sosfilt_zi(sections) * run.acceleration[0]
    weighted = scipy.signal.sosfilt(sections, run.acceleration, zi=states)[0]
    stretches = np.lib.stride_tricks.sliding_window_view(weighted[start:], samples)
    return float(np.sqrt(np.max(np.mean(stretches**2, axis=1))))


def friction_work(run: IndependentBag, start: int) -> float:
    """Return the friction work in J of all clutches from a step on."""
    if not run.sticks:
        power = np.abs(run.joint('primary_shaft', 'effort') * run.slip)[start:]
        return float(np.sum(power[1:] + power[:-1]) * PERIOD_S / 2.0)
    topics = ('/clutch/phase', '/off_going/clutch/phase')[: 2 if run.shift else 1]
    return sum(math.fsum(run.work('friction_work_j', topic)[start + 1 :]) for topic in topics)


def feedback_start(run: IndependentBag) -> int:
    """Return the step at which feedback starts: in a gear shift the first with a share of 1."""
    if not run.shift:
        return run.start
    whole = np.flatnonzero(run.share[run.start :] >= 1.0)
    return run.start + int(whole[0]) if whole.size else run.steps + 1


def work_over_least(run: IndependentBag) -> float | None:
    """Return the work of the engaging clutch from feedback on over that of a rigid car."""
    start = feedback_start(run)
    if start > run.steps or abs(run.slip[start]) < LEAST_SLIP_RAD_S:
        return None
    car = run.scenario['driveline']
    shaft = car['shaft_inertia']
    if run.shift:  # both primary shafts turn with the wheels
        shaft *= 1.0 + gear_ratio(run) ** 2
    rest = shaft + car['vehicle_inertia'] / total_ratio(run) ** 2
    engine = car['engine_inertia']
    least = engine * rest / (engine + rest) * run.slip[start] ** 2 / 2.0
    if not run.sticks:
        return friction_work(run, start) / least
    return math.fsum(run.work('friction_work_j')[start + 1 :]) / least


def total_ratio(run: IndependentBag) -> float:
    """Return the speed of the engaging clutch's shaft over that of the wheels, rigid."""
    gear, gearbox = run.scenario['gear'], {**GEARBOX, **run.scenario.get('gearbox', {})}
    measured = dict(zip(gearbox['measured_gears'], gearbox['measured_ratios'], strict=True))
    product = gearbox['ratios'][gear - 1] * gearbox['final_drives'][gear - 1]
    return float(measured.get(gear, product))


def gear_ratio(run: IndependentBag) -> float:
    """Return the speed of the off-going shaft over that of the on-coming one, both engaged."""
    off_going = run.joint('primary_shaft', 'velocity', '/off_going/joint_states')
    return float(off_going[run.start] / run.joint('primary_shaft', 'velocity')[run.start])


def of_shift(run: IndependentBag) -> dict[str, Figure]:
    """Return the figures of a gear shift; its torque phase ends with the first share of 1."""
    begins, feedback = run.start * PERIOD_S, feedback_start(run)
    handed_over = feedback <= run.steps
    lock_s = first_lock(run, feedback) if handed_over else None
    # A lock within a period counts from the step that ends it on.
    until = run.steps if lock_s is None else math.ceil(lock_s / PERIOD_S - 1e-9)
    shifting = slice(run.start, until + 1)
    wheels = run.joint('driveshaft', 'effort')
    dip = wheels[run.start] - np.min(wheels[shifting])
    rise = run.joint('engine', 'velocity') - gear_ratio(run) * run.joint(
        'primary_shaft', 'velocity'
    )
    loose = np.array(run.of_phase('phase', '/off_going/clutch/phase')) != 'locked'
    tie_up = run.work('tie_up_work_j', '/off_going/clutch/phase')
    return {
        'torque_dip_percent': 100.0 * dip / wheels[run.start] if wheels[run.start] > 0.0 else None,
        'flare_rad_s': float(np.max(np.maximum(rise, 0.0)[shifting] * loose[shifting])),
        'tie_up_work_j': math.fsum(tie_up[run.start + 1 :]),
        'shift_time_s': None if lock_s is None else lock_s - begins,
        'torque_phase_s': feedback * PERIOD_S - begins if handed_over else None,
        'inertia_phase_s': None if lock_s is None else lock_s - feedback * PERIOD_S,
    }


def first_lock(run: IndependentBag, start: int) -> float | None:
    """Return the scenario time of the first lock from a step on; of that step if locked then."""
    if run.of_phase('phase')[start] == 'locked':
        return start * PERIOD_S
    locks = (event.time_s for event in run.events() if event.kind == LOCK and event.step > start)
    return next(locks, None)


if __name__ == '__main__':
    for argument in sys.argv[1:]:
        print(json.dumps({'bag': argument, **independent_figures(Path(argument))}))
