# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A recording: the signals of a run, its facts, settings and message counts."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from ddct_bringup.bag.realtime_facts import RealtimeFacts
from ddct_bringup.bag.run_facts import MEASURED, RunFacts
from ddct_bringup.bag.run_info import RunInfoOfNodes
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import SCHEMA_KEY
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.scenario.content import scenario_from_mapping
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True)
class Recording:
    """Contents of a complete bag: signals, facts of the run, run_info and message counts."""

    path: Path
    """Path of the MCAP file."""
    trajectory: Trajectory
    facts: RunFacts
    custom_data: dict[str, str] = field(default_factory=dict)
    run_info: RunInfoOfNodes = field(default_factory=dict)
    """Parameters and version of each node, by full node name."""
    counts: dict[str, int] = field(default_factory=dict)
    """Number of messages by resolved topic name."""
    missed: dict[str, int] = field(default_factory=dict)
    """Number of stamps without a reply, by reply topic; real time only."""
    realtime: RealtimeFacts = field(default_factory=RealtimeFacts)
    """Counts and safe states published on `/diagnostics`; empty in lock-step."""
    absent: Mapping[str, str] = field(default_factory=dict)
    """
    Reason by quantity for quantities that the recording lacks: NaN in the log of another tool,
    and no signal of the trajectory where a controller's node leaves out an optional topic.
    """
    simulated: RunSettings | None = None
    """Settings of a run that was simulated in this process; None of a bag."""

    @cached_property
    def settings(self) -> RunSettings | None:
        """Settings of the run; None where the bag lacks them or this version cannot build them."""
        if self.simulated is not None:
            return self.simulated
        facts = self.facts
        try:
            return RunSettings(
                scenario_from_mapping(self._scenario),
                facts.architecture,
                facts.clutch,
                facts.wear_gain,
                facts.mode,
                facts.seed,
                **facts.of_shift,
            )
        except (DdctError, TypeError, ValueError):
            return None

    @property
    def measured(self) -> bool:
        """Whether this is the log of another tool, without the files beside a bag."""
        return self.facts.mode == MEASURED

    @property
    def before_schema(self) -> bool:
        """Whether the recorded scenario is older than the version numbers of scenarios."""
        return not isinstance(self._scenario, dict) or SCHEMA_KEY not in self._scenario

    @cached_property
    def _scenario(self) -> Any:
        """Content of the recorded scenario; None without a readable one."""
        try:
            return parse_yaml(self.custom_data.get('scenario_yaml', ''))
        except DdctError:
            return None
