# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics, criteria and verdicts of many runs that are not recorded."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.columns import stacked
from ddct_bringup.scores.metrics import METRIC_NAMES, metric_values
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.criteria import existing, finite, raw_criteria
from ddct_bringup.verdict.judged_run import JudgedRun, Values, step_at
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.plant import JudgedPlant
from ddct_bringup.verdict.state import slip_state
from ddct_bringup.verdict.verdict import judged_traction, verdict_of
from ddct_bringup.verdict.vibration import BAND_PASS_ORDER, SHORTEST_JUDDER_S, at_rest, band_pass
from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S, steps_in, time_of_step
from ddct_plant.scenario.settings import RunSettings

_NO_TIMING = {'update_time_median_us': None, 'update_time_p99_us': None, 'worst_lateness_us': None}
_NOTHING_MISSED = {'missed_steps': 0, 'resends': 0}
_PADDING = 3 * (2 * BAND_PASS_ORDER + 1)
"""Number of samples that `sosfiltfilt` adds at each end of an interval."""


def stacked_results(
    runs: Sequence[RunSettings], trajectory: Trajectory, limits: Limits
) -> list[ScoredRun]:
    """
    Return the results of runs of one length, control start and score window.

    `trajectory` is a stack of these runs in which all values are finite. All are valid, and have
    neither a bag nor facts: the caller knows them. The times of updates are None.
    """
    scenario = runs[0].scenario
    start = scenario.control_start_step
    window = tuple(steps_in('score_window_s', time) for time in scenario.score_window_s)
    of_loop = {'steps': trajectory.steps, **_NO_TIMING, **_NOTHING_MISSED}
    metrics: dict[str, Any] = {**metric_values(trajectory, start, window), **of_loop}
    plants = [JudgedPlant.of(run.scenario) for run in runs]
    judged = JudgedRuns(
        trajectory,
        start,
        scenario.score_window_s,
        metrics,
        limits.rules.engagements_a_day,
        stacked_plants(plants),
    )
    driving = np.asarray(judged.driving_acceleration).tolist()
    by_metric = _rows({name: metrics[name] for name in METRIC_NAMES}, len(runs))
    by_criterion = _rows(raw_criteria(judged), len(runs))
    by_existence = _rows(existing(judged), len(runs))
    results = []
    for index, (run, plant) in enumerate(zip(runs, plants, strict=True)):
        state = slip_state(one_or_more(trajectory, index), start, limits.rules, plant)
        verdict = verdict_of(
            state,
            by_criterion[index],
            limits,
            run.scenario.name,
            exists=by_existence[index],
            traction=judged_traction(finite(driving[index]), plant, limits),
        )
        results.append(ScoredRun('', None, True, '', by_metric[index], verdict))
    return results


def stacked_plants(plants: Sequence[JudgedPlant]) -> Any:
    """Return one plant whose parameters are those of many plants, (R,) each."""
    return JudgedPlant(**vars(stacked(plants)))


def one_or_more(stack: Trajectory, index: Any) -> Trajectory:
    """Return one run of a stack for an integer index, or a smaller stack."""
    return Trajectory({name: values[index] for name, values in stack.signals.items()})


def _rows(columns: Mapping[str, Any], runs: int) -> list[dict[str, float | int | None]]:
    """Return the values of each run by name, None for a value that is not finite."""
    lists = [_column(values, runs) for values in columns.values()]
    return [dict(zip(columns, row, strict=True)) for row in zip(*lists, strict=True)]


def _column(values: Any, runs: int) -> list[float | int | None]:
    if not isinstance(values, np.ndarray):
        return [values] * runs
    return [value if math.isfinite(value) else None for value in values.tolist()]


@dataclass(frozen=True)
class JudgedRuns(JudgedRun):
    """
    R runs of one length and score window whose trajectory is a stack of finite signals.

    Their clutches are linear, and never lock. Values are (R,), not finite where they are not
    defined.
    """

    @cached_property
    def first_together(self) -> np.ndarray:
        """First step at or after t_a, (R,); one after the last step where there is none."""
        at_s = time_of_step(self.control_start) + self.metrics['engagement_time_s']
        steps = self.trajectory.slip_speed.shape[-1]
        return np.array([steps if np.isnan(time) else step_at(time) for time in at_s.tolist()])

    @property
    def slips_for_judder(self) -> np.ndarray:
        """Whether the clutch slips long enough for a judder, (R,)."""
        first, after = self.slipping_spans
        return (after - first - 1) * PERIOD_S >= SHORTEST_JUDDER_S

    @cached_property
    def slipping_spans(self) -> tuple[np.ndarray, np.ndarray]:
        """First sample with slip from control start on, and one after the last, (R,) each."""
        sample = np.arange(self.trajectory.slip_speed.shape[-1])
        mask = self.trajectory.slip_speed != 0.0
        mask &= sample >= self.control_start
        mask &= sample < self.first_together[:, np.newaxis]
        first, after = np.argmax(mask, axis=-1), len(sample) - np.argmax(mask[:, ::-1], axis=-1)
        return first, np.where(mask.any(axis=-1), after, first)

    @cached_property
    def shuffle(self) -> tuple[Values, Values]:
        """Amplitude in rpm and decay time in s of w_sr after the plates have engaged."""
        samples = np.arange(self.torsion_speed_rpm.shape[-1])
        together = samples >= self.first_together[:, np.newaxis]
        magnitude = np.where(together, np.abs(self.torsion_speed_rpm), -1.0)
        peak, largest = np.argmax(magnitude, axis=-1), np.max(magnitude, axis=-1)
        above = magnitude >= largest[:, np.newaxis] / np.e
        after = len(samples) - np.argmax(above[:, ::-1], axis=-1)
        met = together[:, -1]
        decay = np.where(met & (after < len(samples)), (after - peak) / STEPS_PER_S, np.nan)
        return np.where(met, largest, np.nan), decay

    @property
    def judder(self) -> Values:
        """R.m.s. in rpm of w_sr from 2 to 20 Hz while the clutch slips."""
        first, after = self.slipping_spans
        long = self.slips_for_judder
        found = np.full(len(first), np.nan)
        if long.any():
            found[long] = judder_of(self.torsion_speed_rpm[long], first[long], after[long])
        return found

    @cached_property
    def strongest(self) -> tuple[Values | None, Values | None]:
        """Largest weighted acceleration in m/s^2 and dose in m/s^1.75, (R,) each."""
        dose = self.metrics['vdv_m_s1_75']
        defined = np.isfinite(dose)
        if not defined.any():
            return None, None
        found = super().strongest
        acceleration, strongest = (np.where(defined, each, np.nan) for each in np.array(found))
        return acceleration, strongest


def judder_of(torsion_speed: np.ndarray, first: np.ndarray, after: np.ndarray) -> np.ndarray:
    """
    Return the judder of torsion_speed[r, first[r]:after[r]] as `vibration.judder` does, (R,).

    `torsion_speed` is (R, N+1); an interval has more than `_PADDING` samples. Each is shifted to
    the start of its row, so that one call filters all; samples after an interval do not count.
    """
    sos = band_pass()
    length = (after - first)[:, np.newaxis]
    place = np.arange(torsion_speed.shape[-1] + 2 * _PADDING)
    padded = _padded(torsion_speed, first[:, np.newaxis], length, place - _PADDING)
    forward = scipy.signal.sosfilt(sos, padded, zi=at_rest(sos, padded[:, :1]))[0]
    backward_place = np.maximum(length + 2 * _PADDING - 1 - place, 0)
    turned = np.take_along_axis(forward, backward_place, axis=-1)
    filtered = scipy.signal.sosfilt(sos, turned, zi=at_rest(sos, turned[:, :1]))[0]
    inside = (place >= _PADDING) & (place < _PADDING + length)
    return np.sqrt(np.sum(np.where(inside, filtered, 0.0) ** 2, axis=-1) / length[:, 0])


def _padded(
    values: np.ndarray, first: np.ndarray, length: np.ndarray, sample: np.ndarray
) -> np.ndarray:
    """Return the intervals with point-symmetric extensions about their end values."""
    last = length - 1
    turned = np.where(sample > last, 2 * last - sample, np.abs(sample))
    mirrored = np.take_along_axis(values, first + np.clip(turned, 0, last), axis=-1)
    ends = np.take_along_axis(values, first + np.where(sample < 0, 0, last), axis=-1)
    beyond = (sample < 0) | (sample > last)
    return np.where(beyond, 2.0 * ends - mirrored, mirrored)
