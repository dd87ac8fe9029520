# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The scored run: facts, validity, metrics and verdict of one run."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ddct_bringup.bag.run_facts import MEASURED, RunConditions
from ddct_bringup.metrics.catalogue import OF_SHIFT
from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.verdict.verdict import Verdict
from ddct_plant.signals.gain_changes import GainChange


@dataclass(frozen=True)
class ScoredRun:
    """One run with its scores, for every table, file and page that shows it."""

    bag: str
    """Name of the bag; that of the controller for a run without one."""
    facts: RunConditions | None
    """Conditions of the run; None where the bag has none that can be read."""
    valid: bool
    reason: str
    """Reason why the run is not valid; empty for a valid one."""
    metrics: Metrics
    verdict: Verdict
    fallbacks: int | None = None
    """Number of steps without a solution of the controller's program; None without a count."""
    safe_state: str | None = None
    """Nodes in their safe state with the scenario time; None in lock-step."""
    before_schema: bool | None = None
    """Whether the scenario is older than its version numbers; None of an unreadable run."""
    scenario_changes: tuple[str, ...] | None = None
    """Changes of the packaged scenario as KEY=VALUE; None where the scenario is unknown."""
    gain_changes: tuple[GainChange, ...] = ()
    """Gains of the controller that were changed while it ran."""
    not_computed: Mapping[str, str] = field(default_factory=dict)
    """Reason by metric or criterion that lacks its value, where the reason is known."""
    over_floor: Mapping[str, float | None] = field(default_factory=dict)
    """
    Value over the least at the run's own lock instant, by the metric's name in `ddct limit`.

    None where it is not defined; only metrics whose floors were requested.
    """
    no_floor: str = ''
    """Reason why the run has no floors though they were requested; empty otherwise."""

    @property
    def controller(self) -> str | None:
        """Name of the controller; None where it cannot be read."""
        return self.facts.controller if self.facts else None

    @property
    def scenario(self) -> str | None:
        """Name of the scenario; None where it cannot be read."""
        return self.facts.scenario if self.facts else None

    @property
    def is_shift(self) -> bool:
        """Whether the run is a gear shift that has scores."""
        return any(self.metrics.get(each.key) is not None for each in OF_SHIFT)

    @property
    def label(self) -> str:
        """Name of the controller, or of the bag where the controller cannot be read."""
        return self.controller or self.bag

    @property
    def measured(self) -> bool:
        """Whether this is the log of another tool."""
        return self.facts is not None and self.facts.mode == MEASURED
