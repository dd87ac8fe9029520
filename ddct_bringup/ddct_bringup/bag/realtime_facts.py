"""What a real-time run says of itself on `/diagnostics`, live and in its bag."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ddct_plant.graph.topics import SAFE_STATE, SINCE, TICKS_STATUS


@dataclass
class RealtimeFacts:
    """The last counts of the driveline, and who went to its safe state."""

    steps: int = 0
    """Step at which the driveline counted."""
    missed_steps: int = 0
    resends: int = 0
    late_messages: int = 0
    worst_lateness_us: float | None = None
    """How much too late the driveline took a step at most; None in lock-step."""
    safe_states: dict[str, int] = field(default_factory=dict)
    """Per node the stamp in ns since when it is in its safe state."""

    def hear(self, name: str, pairs: Mapping[str, str]) -> bool:
        """Take one status; say whether it was one of ours."""
        try:
            if name.endswith(SAFE_STATE):
                self.safe_states[name.removesuffix(SAFE_STATE)] = int(pairs[SINCE])
                return True
            if name != TICKS_STATUS:
                return False
            self.steps = int(pairs['steps'])
            self.missed_steps = int(pairs['missed_steps'])
            self.resends = int(pairs['resends'])
            self.late_messages = int(pairs['late_messages'])
            if 'worst_tick_lateness_us' in pairs:
                self.worst_lateness_us = float(pairs['worst_tick_lateness_us'])
        except (KeyError, ValueError):
            return False
        return True
