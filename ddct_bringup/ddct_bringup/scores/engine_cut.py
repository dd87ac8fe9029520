# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Note on runs whose engine reaches its fuel cut, which their figures then show too."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.coverage import cut_step, shorter_drive
from ddct_bringup.metrics.lockup import Lockup
from ddct_bringup.metrics.signals.vibration import jerk
from ddct_plant.base.timebase import time_of_step
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True)
class EngineCut:
    """The first fuel cut of a run after control start."""

    speed_rad_s: float
    """Speed of the cut, `cut_rad_s`."""
    step: int
    peak_jerk_step: int
    locked_before: bool
    """Whether the plates lock for good before the cut."""


def engine_cut(settings: RunSettings, run: Trajectory) -> EngineCut | None:
    """Return the first fuel cut of a run after control start, None without one."""
    first, limits = settings.scenario.control_start_step, settings.scenario.engine_limits
    step = cut_step(settings, run, first)
    if step is None or limits is None:
        return None
    peak = first + int(np.argmax(np.abs(jerk(run.vehicle_accel)[first:])))
    lock_s = float(Lockup(run, first).final_lock_s) if run.clutch_phase is not None else np.nan
    locked = 0.0 < lock_s < time_of_step(step - first)
    return EngineCut(limits.cut_rad_s, step, peak, locked)


def cut_note(cuts: Mapping[str, EngineCut]) -> str:
    """Return the note on runs, by name, whose engines reach the cut; empty without one."""
    if not cuts:
        return ''
    first = min(cuts.values(), key=lambda each: each.step)
    peaks = [
        f'{name} ({time_of_step(each.peak_jerk_step):.2f} s)'
        for name, each in cuts.items()
        if each.peak_jerk_step >= each.step
    ]
    note = (
        f'the engine reaches its cut, {first.speed_rad_s:g} rad/s, at '
        f'{time_of_step(first.step):.2f} s in {", ".join(cuts)}'
    )
    if peaks:
        note += f'; the cut makes the peak jerk of {", ".join(peaks)}'
    if all(each.locked_before for each in cuts.values()):
        note += f': {shorter_drive(first.step)}'
    return note
