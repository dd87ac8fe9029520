"""What the criteria are computed from, of many runs with a linear clutch."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from ddct_bringup.verdict.judged_run import JudgedRun, Values, step_at
from ddct_bringup.verdict.vibration import BAND_PASS_ORDER, SHORTEST_JUDDER_S, at_rest, band_pass
from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S, time_of_step

_PADDING = 3 * (2 * BAND_PASS_ORDER + 1)
"""Samples that `sosfiltfilt` adds at both ends of a stretch."""


@dataclass(frozen=True)
class JudgedRuns(JudgedRun):
    """
    R runs of one length and score window whose trajectory is a stack; all signals are finite.

    Their clutches are linear, and never lock.

    Values are (R,), not finite where they are not defined.
    """

    @cached_property
    def first_together(self) -> np.ndarray:
        """First step at or after t_a, (R,); one behind the last where there is none."""
        at_s = time_of_step(self.control_start) + self.metrics['engagement_time_s']
        steps = self.trajectory.slip_speed.shape[-1]
        return np.array([steps if np.isnan(time) else step_at(time) for time in at_s.tolist()])

    @property
    def slipping_stretches(self) -> tuple[np.ndarray, np.ndarray]:
        """First sample of the longest stretch of slipping and the one behind its last, (R,)."""
        runs, samples = self.trajectory.slip_speed.shape
        mask = self.trajectory.slip_speed != 0.0
        mask &= np.arange(samples) < self.first_together[:, np.newaxis]
        changes = np.diff(mask, prepend=False, append=False, axis=-1)
        rows, edges = (each.reshape(-1, 2) for each in np.nonzero(changes))
        # Each row's stretches from the longest to the shortest, the earlier of equals first.
        order = np.lexsort((edges[:, 0], edges[:, 0] - edges[:, 1], rows[:, 0]))
        found, at = np.unique(rows[order, 0], return_index=True)
        longest = np.zeros((runs, 2), dtype=int)
        longest[found] = edges[order][at]
        return longest[:, 0], longest[:, 1]

    @cached_property
    def shuffle(self) -> tuple[Values, Values]:
        """Amplitude in rpm and decay in s of w_sr once the plates are together."""
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
        """R.m.s. in rpm of w_sr from 2 to 20 Hz over the longest stretch of slipping."""
        first, after = self.slipping_stretches
        long = (after - first - 1) * PERIOD_S >= SHORTEST_JUDDER_S
        found = np.full(len(first), np.nan)
        if long.any():
            found[long] = judder_of(self.torsion_speed_rpm[long], first[long], after[long])
        return found

    @cached_property
    def strongest(self) -> tuple[Values | None, Values | None]:
        """Weighted acceleration and dose where they are strongest."""
        dose = self.metrics['vdv_m_s1_75']
        defined = np.isfinite(dose)
        if not defined.any():
            return None, None
        found = super().strongest
        acceleration, strongest = (np.where(defined, each, np.nan) for each in np.array(found))
        return acceleration, strongest


def judder_of(torsion_speed: np.ndarray, first: np.ndarray, after: np.ndarray) -> np.ndarray:
    """
    Return what `vibration.judder` returns of torsion_speed[r, first[r]:after[r]], (R,).

    `torsion_speed` is (R, N+1); a stretch has more than `_PADDING` samples. Each is moved to the
    start of its row, so that one call filters all; what stands behind a stretch does not count.
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
    """Return samples of the stretches, beyond their ends turned about the value there."""
    last = length - 1
    turned = np.where(sample > last, 2 * last - sample, np.abs(sample))
    mirrored = np.take_along_axis(values, first + np.clip(turned, 0, last), axis=-1)
    ends = np.take_along_axis(values, first + np.where(sample < 0, 0, last), axis=-1)
    beyond = (sample < 0) | (sample > last)
    return np.where(beyond, 2.0 * ends - mirrored, mirrored)
