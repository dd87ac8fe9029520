# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A recording: the signals of a run, its facts and settings."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from ddct_bringup.bag.realtime_facts import RealtimeFacts
from ddct_bringup.bag.run_facts import MEASURED, RunFacts
from ddct_bringup.bag.run_info import RunInfoOfNodes
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals.gain_changes import GainChange, gain_changes


@dataclass(frozen=True)
class Recording:
    """Contents of a bag: signals, facts of the run and run_info."""

    path: Path
    """Path of the MCAP file."""
    trajectory: Trajectory
    facts: RunFacts
    custom_data: dict[str, str] = field(default_factory=dict)
    run_info: RunInfoOfNodes = field(default_factory=dict)
    """Parameters and version of each node, by full node name."""
    missed: dict[str, int] = field(default_factory=dict)
    """Number of stamps without a reply, by reply topic; real time only."""
    realtime: RealtimeFacts = field(default_factory=RealtimeFacts)
    """Counts and safe states published on `/diagnostics`; empty in lock-step."""
    absent: Mapping[str, str] = field(default_factory=dict)
    """
    Reason by quantity for quantities that the recording lacks: NaN in the log of another tool,
    and no signal of the trajectory where a controller's node leaves out an optional topic.
    """
    unfinished: bool = False
    """Whether the bag has no footer: it is the beginning of a run, without scores."""
    settings: RunSettings | None = None
    """Settings of the run; None of the log of another tool."""

    @cached_property
    def gain_changes(self) -> tuple[GainChange, ...]:
        """Gains that were changed in the run; raise DdctError for an unreadable change."""
        return gain_changes(self.trajectory.status)

    @property
    def measured(self) -> bool:
        """Whether this is the log of another tool, without the files beside a bag."""
        return self.facts.mode == MEASURED
