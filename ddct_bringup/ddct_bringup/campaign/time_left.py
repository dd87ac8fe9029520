"""How long the rest of a campaign takes: each controller by its own shards."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ddct_bringup.campaign.shards import ShardJob


@dataclass
class TimeLeft:
    """Estimates the time that remains from shards that are done."""

    cases: int
    """Runs of each controller: the first so many are those of the first controller."""
    _runs: dict[int, int] = field(default_factory=dict)
    _seconds: dict[int, float] = field(default_factory=dict)

    def add(self, job: ShardJob, seconds: float) -> None:
        """Count a shard that took a worker so many seconds."""
        for controller, runs in self._parts(job):
            share = seconds * runs / (job.last - job.first)
            self._runs[controller] = self._runs.get(controller, 0) + runs
            self._seconds[controller] = self._seconds.get(controller, 0.0) + share

    def left_s(self, missing: Iterable[ShardJob], workers: int) -> float | None:
        """
        Return the seconds that the missing shards take so many workers, None before the first.

        A controller of which no shard is done yet counts like the mean of the others.
        """
        if not self._runs:
            return None
        rates = {each: self._seconds[each] / self._runs[each] for each in self._runs}
        mean = sum(rates.values()) / len(rates)
        parts = [part for job in missing for part in self._parts(job)]
        return sum(runs * rates.get(controller, mean) for controller, runs in parts) / workers

    def _parts(self, job: ShardJob) -> Iterable[tuple[int, int]]:
        """Yield each controller in a shard, by its place, with how many of its runs are there."""
        for controller in range(job.first // self.cases, (job.last - 1) // self.cases + 1):
            first = max(job.first, controller * self.cases)
            yield controller, min(job.last, (controller + 1) * self.cases) - first


def each_controller_first(shards: Mapping[Path, ShardJob], cases: int) -> Sequence[Path]:
    """
    Return the files of shards in the order in which they are to be computed.

    The first shard of each controller comes before all others, so that soon each is measured.
    """
    first: dict[int, Path] = {}
    for file, job in shards.items():
        first.setdefault(job.first // cases, file)
    chosen = set(first.values())
    return [*first.values(), *(file for file in shards if file not in chosen)]
