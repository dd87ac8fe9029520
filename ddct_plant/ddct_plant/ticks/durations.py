# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""How long things took in a real-time run: counts in bins, in a memory that does not grow."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from ddct_plant.base.timebase import PERIOD_S

BINS_PER_OCTAVE = 16
"""Number of bins from a duration to the double of it, so that a bin is 4.4 % wide."""
LAST_BIN = 36 * BINS_PER_OCTAVE
"""Bin of the durations of 19 hours and more."""
_REMEMBERED = 1024
"""Number of ticks after which a late reply no longer counts."""


@dataclass
class DurationHistogram:
    """Counts of durations in bins of equal ratio from 1 us up, and the largest one exactly."""

    largest_us: float = 0.0
    """Largest duration, us; to a tenth of a us."""
    counts: dict[int, int] = field(default_factory=dict)
    """
    Number of durations by bin.

    Bin b begins at 2**(b / `BINS_PER_OCTAVE`) us; bin 0 also has those below.
    """

    def add(self, duration_s: float) -> None:
        """Count one duration in s."""
        duration_us = max(1e6 * duration_s, 1.0)
        place = min(int(BINS_PER_OCTAVE * math.log2(duration_us)), LAST_BIN)
        self.counts[place] = self.counts.get(place, 0) + 1
        self.largest_us = max(self.largest_us, round(duration_us, 1))

    @property
    def total(self) -> int:
        """Number of durations."""
        return sum(self.counts.values())

    def percentile_us(self, percent: float) -> float | None:
        """
        Return a duration in us which that many percent of all do not exceed; None without any.

        It is the upper end of a bin, so too large by 4.4 % at most, or the largest duration.
        """
        needed, counted = percent / 100.0 * self.total, 0
        for place in sorted(self.counts):
            counted += self.counts[place]
            if counted >= needed:
                return min(upper_end_us(place), self.largest_us)
        return None

    def text(self) -> str:
        """Return the largest duration and the counts as text."""
        pairs = (f'{place}:{self.counts[place]}' for place in sorted(self.counts))
        return ' '.join([repr(self.largest_us), *pairs])

    @classmethod
    def of(cls, text: str) -> 'DurationHistogram':
        """Return the histogram of a text; raise ValueError for another text."""
        largest, *pairs = text.split()
        split = (pair.split(':') for pair in pairs)
        return checked(float(largest), {int(place): int(count) for place, count in split})


def checked(largest_us: float, counts: Mapping[int, int]) -> DurationHistogram:
    """Return a histogram of numbers from outside; raise ValueError for impossible ones."""
    if not 0.0 <= largest_us < math.inf:
        raise ValueError(f'the largest duration is {largest_us} us')
    for place, count in counts.items():
        if not (0 <= place <= LAST_BIN and 0 < count < 2**53):
            raise ValueError(f'bin {place} has the count {count}')
    return DurationHistogram(largest_us, dict(counts))


def upper_end_us(place: int) -> float:
    """Return the upper end of a bin in us."""
    return 2.0 ** ((place + 1) / BINS_PER_OCTAVE)


class TickDurations:
    """
    Durations of the ticks of a real-time run, measured where time is owned.

    `lateness` is the time by which a tick is published after it is due, `jitter` the difference
    of a period from its nominal length, and `latency` the time from the publication of a tick to
    the arrival of the torque of a clutch that answers it, however late.
    """

    def __init__(self, clock: Callable[[], float], period_s: float = PERIOD_S) -> None:
        """Measure ticks with a period in s by a steady clock in s."""
        self.histograms = {name: DurationHistogram() for name in ('lateness', 'jitter', 'latency')}
        self._clock = clock
        self._period_s = period_s
        # Of no step: the number of a false stamp may be any, below 0 too.
        self._sent: list[tuple[int | None, float]] = [(None, 0.0)] * _REMEMBERED

    def publish(self, step: int, late_s: float) -> None:
        """Note that the tick of a step is being published, `late_s` after it was due."""
        now = self._clock()
        before, sent_at = self._sent[(step - 1) % _REMEMBERED]
        if before == step - 1:
            self.histograms['jitter'].add(abs(now - sent_at - self._period_s))
        self.histograms['lateness'].add(late_s)
        self._sent[step % _REMEMBERED] = step, now

    def answer(self, step: int) -> None:
        """Note the arrival of a reply to the tick of a step."""
        published, sent_at = self._sent[step % _REMEMBERED]
        if published == step:
            self.histograms['latency'].add(self._clock() - sent_at)
