# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The scored run: facts, validity, state, metrics and limits of one run."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ddct_bringup.bag.run_facts import MEASURED, RunConditions
from ddct_bringup.metrics.catalogue import JERK_OVER_LEAST, METRICS
from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.scores.engine_cut import EngineCut
from ddct_bringup.verdict.limits import LimitResult
from ddct_plant.signals.gain_changes import GainChange

LEAST_IS_BOUND = 'least_is_bound'
"""Key of that in `figures`, and of its reason in `null_reasons`."""
YARDSTICK = 'the least is a yardstick, not a bound'
"""What the star beside a ratio to the least says."""


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
    """Every figure and metric; `scores.json` has them apart."""
    state: str
    """State of the run, one of `STATES`."""
    why: str = ''
    """Reason of the state; empty where its name says all."""
    limits: tuple[LimitResult, ...] = ()
    """Metrics beside their limits; empty of an unreadable run."""
    fallbacks: int | None = None
    """Number of steps without a solution of the controller's program; None without a count."""
    safe_state: str | None = None
    """Nodes in their safe state with the scenario time; None in lock-step."""
    scenario_changes: tuple[str, ...] | None = None
    """Changes of the packaged scenario as KEY=VALUE; None where the scenario is unknown."""
    gain_changes: tuple[GainChange, ...] = ()
    """Gains of the controller that were changed while it ran."""
    null_reasons: Mapping[str, str] = field(default_factory=dict)
    """Reason by metric that has no value, and why the least is no bound for the run."""
    engine_cut: EngineCut | None = None
    """First fuel cut of the engine after control start; None without one. No file has it."""
    least_is_bound: bool | None = None
    """
    Whether no run like this one can have a peak jerk below the least of `peak_jerk_over_least`.

    False for a run that is none of those of the floor, with the reason in `null_reasons`: the
    least is then a yardstick. None without that figure.
    """

    @property
    def least_peak_jerk(self) -> float | None:
        """Least peak jerk in m/s^3 at the final lock of the run; None where it has none."""
        jerk, ratio = self.metrics['peak_jerk_m_s3'], self.metrics[JERK_OVER_LEAST.key]
        return jerk / ratio if jerk is not None and ratio else None

    @property
    def outside(self) -> str:
        """Why the least is no bound for the run, in words after its name; empty where it is."""
        return self.null_reasons.get(LEAST_IS_BOUND, '') if self.least_is_bound is False else ''

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
        return any(
            self.metrics.get(each.key) is not None for each in METRICS.values() if each.of_shift
        )

    @property
    def label(self) -> str:
        """Name of the controller, or of the bag where the controller cannot be read."""
        return self.controller or self.bag

    @property
    def measured(self) -> bool:
        """Whether this is the log of another tool."""
        return self.facts is not None and self.facts.mode == MEASURED
