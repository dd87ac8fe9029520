# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Counts of a real-time run, and the safe states of its nodes."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ddct_bringup.bag.run_info import DRIVELINE_NODE
from ddct_plant.graph.node_names import StatusName
from ddct_plant.graph.node_reports import SAFE_STATE, TICKS, TickCounts, safe_state_since


@dataclass
class RealtimeCounts:
    """Counts of a real-time run by the driveline, and the nodes that entered their safe state."""

    missed_steps: int = 0
    """Number of steps that held the last torque because a reply was missing."""
    resends: int = 0
    """Number of ticks that were sent again."""
    late_messages: int = 0
    """Number of replies to a tick that was over."""
    safe_states: dict[str, int] = field(default_factory=dict)
    """Stamp in ns at which a node entered its safe state, by full node name."""
    lateness_us: list[float] = field(default_factory=list)
    """Time by which each step of the driveline began too late, us; empty in lock-step."""
    latency_us: list[float] = field(default_factory=list)
    """Time from the publication of a tick to each torque of a clutch that answers it, us; empty in
    lock-step."""

    @property
    def worst_lateness_us(self) -> float | None:
        """Largest lateness of a step of the driveline, us; None in lock-step."""
        return max(self.lateness_us, default=None)


@dataclass
class RealtimeFacts(RealtimeCounts):
    """Last counts and safe states published on `/diagnostics` of a real-time run or of its bag."""

    steps: int = 0
    """Step of the driveline's last count."""

    def receive(self, name: StatusName, pairs: Mapping[str, str]) -> bool:
        """Store one status of `/diagnostics`; return whether it is one of this project's."""
        try:
            if name.node and name.what == SAFE_STATE:
                self.safe_states[name.node] = safe_state_since(pairs)
                return True
            if name != (DRIVELINE_NODE, TICKS):
                return False
            counts = TickCounts.of(pairs)
        except (KeyError, ValueError):
            return False
        self.steps, self.resends = counts.steps, counts.resends
        self.missed_steps, self.late_messages = counts.missed_steps, counts.late_messages
        self.lateness_us += counts.lateness_us
        self.latency_us += counts.latency_us
        return True
