"""Read the wall-clock figures of a run, which stand beside its bag in `timing.json`."""

import json
from pathlib import Path

from ddct_bringup.run.run_timing import TIMING_FILE, RunTiming
from ddct_plant.errors import DdctError


def read_timing(folder: Path) -> RunTiming | None:
    """Return the timing of a bag folder, None without one; raise DdctError if it is unusable."""
    path = folder / TIMING_FILE
    try:
        text = path.read_text(encoding='utf-8')
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError) as error:
        raise DdctError(f'{path}: cannot read the timing: {error}') from error
    try:
        values = json.loads(text)
        return RunTiming(
            update_times_us=[float(time) for time in values['update_times_us']],
            missed_steps=int(values['missed_steps']),
            resends=int(values['resends']),
            late_messages=int(values['late_messages']),
            wall_time_s=float(values['wall_time_s']),
            steps=int(values['steps']),
        )
    except (ValueError, KeyError, TypeError, OverflowError) as error:
        raise DdctError(
            f'{path}: not the timing of a run ({error!r}): delete it to score without'
        ) from error
