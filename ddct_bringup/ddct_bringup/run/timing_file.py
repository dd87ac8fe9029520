"""Read the wall-clock figures of a run, which stand beside its bag in `timing.json`."""

from pathlib import Path

from ddct_bringup.run.run_timing import TIMING_FILE, RunTiming
from ddct_plant.checks import require_number
from ddct_plant.errors import DdctError
from ddct_plant.input_file import read_text_file
from ddct_plant.json_text import parse_json

MOST_BYTES = 50_000_000
"""An hour's run has an eighth of that."""


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
            update_times_us=[
                require_number('update_times_us', time, at_least=0.0)
                for time in values['update_times_us']
            ],
            wall_time_s=require_number('wall_time_s', values['wall_time_s'], at_least=0.0),
            **{
                name: int(require_number(name, values[name], at_least=0.0))
                for name in ('missed_steps', 'resends', 'late_messages', 'steps')
            },
        )
    except (DdctError, LookupError, TypeError) as error:
        raise DdctError(
            f'{path}: not the timing of a run ({error!r}): delete it to score without'
        ) from error
