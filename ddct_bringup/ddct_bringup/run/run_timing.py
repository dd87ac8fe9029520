"""Wall-clock figures of a run, kept out of the bag so that the bag is deterministic."""

import json
import os
from dataclasses import asdict, dataclass, field
from pathlib import Path

from ddct_plant.base.errors import DdctError

TIMING_FILE = 'timing.json'


@dataclass
class RunTiming:
    """What `timing.json` holds."""

    update_times_us: list[float] = field(default_factory=list)
    """Wall time of each controller update, in order."""
    missed_steps: int = 0
    """Real-time steps that had to hold a torque."""
    resends: int = 0
    """Ticks that were sent again."""
    late_messages: int = 0
    """Replies to a tick that was over."""
    refused_messages: int = 0
    """Messages with a stamp that could not be true, real time only."""
    worst_lateness_us: float | None = None
    """How much too late the driveline took a step at most; None in lock-step."""
    safe_states: dict[str, int] = field(default_factory=dict)
    """Per node that went to its safe state the stamp in ns, real time only."""
    wall_time_s: float = 0.0
    """From the first tick to the last."""
    steps: int = 0

    def write(self, folder: Path) -> None:
        """Write `timing.json` into a bag's folder; raise DdctError when that fails."""
        path = folder / TIMING_FILE
        try:
            path.write_text(json.dumps(asdict(self)) + os.linesep, encoding='utf-8')
        except OSError as error:
            raise DdctError(f'{path}: cannot be written ({error.strerror})') from error
