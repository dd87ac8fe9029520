# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Which runs a floor covers: why a run is none of them, and what a run of them proves."""

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.dynamics.capacity import stays_within
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.dynamics.torque_cut import cuts_as_usual
from ddct_bringup.floor.lock import Lock, final_lock_of, lock_of
from ddct_bringup.verdict.rules import Rules
from ddct_plant.base.errors import DdctError
from ddct_plant.models.engine_limits import fuel_is_cut
from ddct_plant.scenario.settings import RunSettings

_BELOW = 1e-6
"""How far a run may be below its floor by rounding, as a share of the floor."""


class FloorWithdrawnError(DdctError):
    """A run that a floor covers is below it: the floor is wrong, whatever its proof says."""


def require_not_below(metric: str, value: float, least: float | None, lock: Lock) -> None:
    """Raise FloorWithdrawnError for a run that the floor `least` covers but that is below it."""
    if least is not None and value < least * (1.0 - _BELOW):
        raise FloorWithdrawnError(
            f'{metric} of a run that locks at {lock.time_s:.3f} s is {value:.4g}, below its '
            f'proven floor {least:.4g}: the floor is withdrawn, its program does not contain '
            'the run; report the case; compare, score and report go on with --floors none'
        )


def cut_step(settings: RunSettings, run: Trajectory, start: int) -> int | None:
    """Return the first step from `start` on at which a run's engine is cut, None without one."""
    limits = settings.scenario.engine_limits
    if limits is None:
        return None
    cuts = np.flatnonzero(fuel_is_cut(limits, run.engine_speed[:-1])[start:])
    return start + int(cuts[0]) if cuts.size else None


def shorter_drive(step: int) -> str:
    """Return how to end a drive before the engine is cut at `step`, at a tenth of a second."""
    return f'shorten the drive: --set duration_s={(step - 1) // 10 / 10.0:g}'


def why_outside(settings: RunSettings, start: Start, run: Trajectory, rules: Rules) -> str:
    """Return why a run is none of those of a floor, in words after its name; '' if it is one."""
    first = start.step
    if run.steps < settings.scenario.steps:
        return 'ends early'
    if run.two_input:
        return 'commands the engine'
    lock = lock_of(run, first, rules)
    if lock is None:
        parts = final_lock_of(run, first, rules) is not None
        return 'slips again' if parts else 'does not lock for good'
    if not np.array_equal(np.maximum(run.torque_request[:first], 0.0), start.requests):
        return 'starts otherwise'
    if cut_step(settings, run, first) is not None:
        return 'meets the cut of the engine'
    if start.off_going and not start.off_going.agrees(run):
        return 'opens the off-going clutch otherwise'
    if start.off_going and not cuts_as_usual(settings, run):
        return 'cuts the torque otherwise'
    if not stays_within(settings, run, first, first + lock.periods + 1, start.temperature_c):
        return 'warms the facing more than the floor allows'
    return ''
