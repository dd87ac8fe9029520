# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Estimate of the remaining time of a campaign from the shards of each controller."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ddct_bringup.campaign.shards import ShardJob


@dataclass
class TimeLeft:
    """Estimates the remaining time from completed shards."""

    cases: int
    """Number of runs of each controller, in the order of the controllers."""
    _runs: dict[int, int] = field(default_factory=dict)
    _seconds: dict[int, float] = field(default_factory=dict)

    def add(self, job: ShardJob, seconds: float) -> None:
        """Count a completed shard with its computing time in s."""
        for controller, runs in self._parts(job):
            share = seconds * runs / (job.last - job.first)
            self._runs[controller] = self._runs.get(controller, 0) + runs
            self._seconds[controller] = self._seconds.get(controller, 0.0) + share

    def left_s(self, missing: Iterable[ShardJob], workers: int) -> float | None:
        """
        Return the time in s for the missing shards with this many workers, None before the first.

        A controller without a completed shard counts as the mean of the others.
        """
        if not self._runs:
            return None
        rates = {each: self._seconds[each] / self._runs[each] for each in self._runs}
        mean = sum(rates.values()) / len(rates)
        parts = [part for job in missing for part in self._parts(job)]
        return sum(runs * rates.get(controller, mean) for controller, runs in parts) / workers

    def _parts(self, job: ShardJob) -> Iterable[tuple[int, int]]:
        """Yield the index of each controller in a shard with the number of its runs there."""
        for controller in range(job.first // self.cases, (job.last - 1) // self.cases + 1):
            first = max(job.first, controller * self.cases)
            yield controller, min(job.last, (controller + 1) * self.cases) - first


def each_controller_first(shards: Mapping[Path, ShardJob], cases: int) -> Sequence[Path]:
    """
    Return the files of shards in the order of their computation.

    The first shard of each controller comes before all others, so that each is soon measured.
    """
    first: dict[int, Path] = {}
    for file, job in shards.items():
        first.setdefault(job.first // cases, file)
    chosen = set(first.values())
    return [*first.values(), *(file for file in shards if file not in chosen)]
