"""How long the controllers took for an update, on a logarithmic scale of wall time."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_bringup.report.runs import ReportRun
from ddct_bringup.run.run_timing import RunTiming
from ddct_plant.base.timebase import PERIOD_S

_FIRST_US, _LAST_US = 1.0, 1e5
TICKS = tuple(
    (text, (math.log10(us / _FIRST_US) / math.log10(_LAST_US / _FIRST_US)))
    for text, us in (('1 µs', 1.0), ('10 µs', 1e1), ('100 µs', 1e2), ('1 ms', 1e3), ('10 ms', 1e4))
)
"""Text and place, 0 to 1, of the marks on the scale; the last is the period."""


@dataclass(frozen=True)
class UpdateTimes:
    """What `timing.json` tells of one run; places are along the scale, 0 to 1."""

    median_us: float
    p99_us: float
    largest_us: float
    timing: RunTiming
    """What else it holds."""
    median_place: float
    p99_place: float
    largest_place: float
    over_period: int
    """Updates that took longer than the period."""


def update_times(run: ReportRun) -> UpdateTimes | None:
    """Return the update times of a run, None where none were recorded."""
    timing = run.timing
    median, p99 = (run.entry['metrics'][f'update_time_{name}_us'] for name in ('median', 'p99'))
    if timing is None or median is None:
        return None
    largest = max(timing.update_times_us)
    return UpdateTimes(
        median_us=median,
        p99_us=p99,
        largest_us=largest,
        timing=timing,
        median_place=_place(median),
        p99_place=_place(p99),
        largest_place=_place(largest),
        over_period=int(np.sum(np.array(timing.update_times_us) > 1e6 * PERIOD_S)),
    )


def _place(time_us: float) -> float:
    place = math.log10(max(time_us, _FIRST_US) / _FIRST_US) / math.log10(_LAST_US / _FIRST_US)
    return min(place, 1.0)
