# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A recording: the signals of a run, its facts, settings and counts, and their agreement."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from ddct_bringup.bag.realtime_facts import RealtimeFacts
from ddct_bringup.bag.run_facts import MEASURED, RunFacts
from ddct_bringup.bag.run_info import CONTROLLER_NODE, DRIVELINE_NODE, RunInfoOfNodes
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.bag_file.facts import KNOWN_SCENARIO, contradiction, recorded_scenario
from ddct_plant.base.clutch_kinds import CLUTCHES
from ddct_plant.base.errors import DdctError, require_choice
from ddct_plant.base.options import options_of
from ddct_plant.files.input_file import SCHEMA_KEY
from ddct_plant.graph.node_reports import CONTROL_NODES, CONTROLLER, DIGEST, STEPS
from ddct_plant.scenario.choices.settings import MODES
from ddct_plant.scenario.content import scenario_from_mapping
from ddct_plant.scenario.file import content_digest
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import UNKNOWN, RunSettings
from ddct_plant.signals.gain_changes import GainChange, gain_changes

_OF_NODES = ('scenario', 'architecture', 'clutch', 'mode', 'seed')
"""Facts that each node publishes on `run_info` too, besides the wear gain."""


@dataclass(frozen=True)
class Recording:
    """Contents of a bag: signals, facts of the run, run_info and message counts."""

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
    unfinished: bool = False
    """Whether the bag has no footer: it is the beginning of a run, without scores."""
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
                known_scenario=self._known_scenario,
            )
        except (DdctError, TypeError, ValueError):
            return None

    @cached_property
    def gain_changes(self) -> tuple[GainChange, ...]:
        """Gains that were changed in the run; raise DdctError for an unreadable change."""
        return gain_changes(self.trajectory.status)

    @property
    def measured(self) -> bool:
        """Whether this is the log of another tool, without the files beside a bag."""
        return self.facts.mode == MEASURED

    @property
    def before_schema(self) -> bool:
        """Whether the recorded scenario is older than the version numbers of scenarios."""
        return not isinstance(self._scenario, dict) or SCHEMA_KEY not in self._scenario

    @property
    def recorded_digest(self) -> str:
        """Digest of the recorded scenario as it is in the bag; 'missing' where there is none."""
        return _digest(self._scenario)

    @cached_property
    def _scenario(self) -> Any:
        """Content of the recorded scenario; None without a readable one."""
        return recorded_scenario(self.custom_data)

    @property
    def _known_scenario(self) -> Scenario | None:
        """Scenario that controllers knew, where the bag has one of its own."""
        if KNOWN_SCENARIO not in self.custom_data:
            return None
        return scenario_from_mapping(recorded_scenario(self.custom_data, KNOWN_SCENARIO))


def require_consistent(recording: Recording) -> None:
    """
    Raise DdctError for a fact that the bag's scenario or one of its nodes contradicts.

    All three were written by one recorder from one set of settings, of which control nodes have
    the known part. Where they differ, the bag was edited, and its scores would be those of another
    run.
    """
    facts = recording.facts
    require_choice('mode', facts.mode, MODES)
    require_choice('clutch', facts.clutch, CLUTCHES)
    if recording.settings:
        scenario = recording.settings.scenario
        _require('scenario', facts.scenario, scenario.name, 'the recorded scenario')
        for name in ('control_start_s', 'score_window_s'):
            ours, theirs = getattr(facts, name), getattr(scenario, name)
            _require(name, ours, theirs, 'the recorded scenario')
    of_all = {name: str(getattr(facts, name)) for name in _OF_NODES}
    of_all |= {'wear_gain': repr(float(facts.wear_gain)), DIGEST: recording.recorded_digest}
    known = of_all | _known(recording)
    of_one = {CONTROLLER_NODE: {CONTROLLER: facts.controller}}
    of_one[DRIVELINE_NODE] = {STEPS: str(facts.steps)}
    for node, pairs in recording.run_info.items():
        of_node = known if node in CONTROL_NODES else of_all
        # Nodes of earlier versions and of third parties need not publish each of them.
        for name, text in (of_node | of_one.get(node, {})).items():
            _require(name, text, pairs.get(name, text), f'node {node}')


def _digest(content: Any) -> str:
    try:
        return content_digest(content)
    except (AttributeError, TypeError):
        return 'missing'


def _known(recording: Recording) -> dict[str, str]:
    """Return the facts on `run_info` of control nodes that differ from the true ones."""
    options = options_of(RunSettings)
    found = {name: str(options[name].default) for name in UNKNOWN if name in _OF_NODES}
    found['wear_gain'] = repr(options['wear_gain'].default)
    if KNOWN_SCENARIO in recording.custom_data:
        found[DIGEST] = _digest(recorded_scenario(recording.custom_data, KNOWN_SCENARIO))
    return found


def _require(name: str, ours: object, theirs: object, whose: str) -> None:
    if ours != theirs:
        raise contradiction(name, ours, theirs, f'in that of {whose}')
