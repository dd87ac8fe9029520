"""Wall-clock figures of a run: `timing.json` beside the bag, which is deterministic without."""

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

from ddct_plant.base.errors import DdctError, require_number
from ddct_plant.files.input_file import parse_json, read_text_file
from ddct_plant.files.output_file import write_text

TIMING_FILE = 'timing.json'
MOST_BYTES = 50_000_000
"""An hour's run has an eighth of that."""


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
        text = json.dumps(asdict(self)) + '\n'
        write_text(str(folder / TIMING_FILE), text, 'choose another output folder')


def read_timing(folder: Path) -> RunTiming | None:
    """Return the timing of a bag folder, None without one; raise DdctError if it is unusable."""
    path = folder / TIMING_FILE
    try:
        text = read_text_file(path, MOST_BYTES)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise DdctError(f'{path}: cannot read the timing: {error.strerror}') from error
    try:
        values = parse_json(text)
        return RunTiming(
            update_times_us=[_positive('update_times_us', x) for x in values['update_times_us']],
            missed_steps=_count('missed_steps', values['missed_steps']),
            resends=_count('resends', values['resends']),
            late_messages=_count('late_messages', values['late_messages']),
            refused_messages=_count('refused_messages', values.get('refused_messages', 0)),
            worst_lateness_us=_optional(values.get('worst_lateness_us')),
            safe_states={
                str(node): _count('safe_states', stamp)
                for node, stamp in values.get('safe_states', {}).items()
            },
            wall_time_s=_positive('wall_time_s', values['wall_time_s']),
            steps=_count('steps', values['steps']),
        )
    except (DdctError, LookupError, TypeError, AttributeError) as error:
        raise DdctError(
            f'{path}: not the timing of a run ({error!r}): delete it to score without'
        ) from error


def _positive(name: str, value: object) -> float:
    return require_number(name, value, at_least=0.0)


def _count(name: str, value: object) -> int:
    return int(_positive(name, value))


def _optional(value: object) -> float | None:
    return None if value is None else _positive('worst_lateness_us', value)
