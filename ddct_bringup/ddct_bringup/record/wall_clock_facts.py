# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Collector of what depends on the wall clock, for `timing.json`."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from ddct_bringup.bag.realtime_facts import RealtimeFacts
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_plant.graph.node_names import StatusName


class WallClockFacts:
    """Update times of the controller, counts of the driveline and safe states of one run."""

    def __init__(self) -> None:
        self._update_times_us: list[float] = []
        self._realtime = RealtimeFacts()

    def add_update_times(self, times_us: Iterable[float]) -> None:
        """Add wall times of controller updates in us."""
        self._update_times_us += times_us

    def receive(self, name: StatusName, pairs: Mapping[str, str]) -> bool:
        """Store one status of `/diagnostics`; return whether it is one of this project's."""
        return self._realtime.receive(name, pairs)

    def write(self, folder: Path, steps: int, wall_time_s: float, late: int, refused: int) -> None:
        """
        Write `timing.json` into the folder of a bag; raise DdctError when that fails.

        `steps` is the last recorded step, `wall_time_s` the time from the first tick to it, `late`
        the number of messages that the recorder received too late, `refused` the number of those
        with an impossible stamp.
        """
        facts = self._realtime
        timing = RunTiming(
            missed_steps=facts.missed_steps,
            resends=facts.resends,
            late_messages=facts.late_messages + late,
            safe_states=facts.safe_states,
            lateness_us=facts.lateness_us,
            latency_us=facts.latency_us,
            update_times_us=self._update_times_us,
            refused_messages=refused,
            wall_time_s=wall_time_s,
            steps=steps,
        )
        timing.write(folder)
