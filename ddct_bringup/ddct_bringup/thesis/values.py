"""
What we compute for the numbers of Chapter 5: Table 5.1 and the words of Table 5.2.

The program `design thesis` finds it through the entry-point group `ddct.thesis_numbers`, because
the closed loop is no part of ddct_controllers.
"""

import math

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.scores.metrics import Metrics, compute_metrics
from ddct_bringup.thesis.runs import THESIS_SCENARIO, thesis_run
from ddct_bringup.thesis.table import CALIBRATED, THESIS_TABLE
from ddct_plant.timebase import steps_in

WORN = (0.7, 1.3)
"""The two critical values of K_usura, inequality (3.2)."""
WORN_ARCHITECTURE = 'feedforward'
"""That of Figure 5.1, the only run with a worn clutch that the thesis shows."""
GOOD_SLIP_RAD_S = 3.0
"""
Below this slip speed at the end of the score window the words of Table 5.2 are `good`.

The thesis names no limit. Hinf2 ends at 0.6 rad/s at most, LS8 at 23 rad/s at least.
"""
_COMPARED = ('ls8', 'hinf2')
"""The linear controllers of Table 5.2."""


def closed_loop_values() -> dict[str, float | str | None]:
    """Return the values by the ids that the thesis gate's file gives them."""
    return {**_table_5_1(), **_table_5_2()}


def _table_5_1() -> dict[str, float | str | None]:
    found: dict[str, float | str | None] = {}
    times: dict[str, float] = {}
    for row in THESIS_TABLE:
        if row.use == CALIBRATED:
            metrics = _metrics(thesis_run(row.controller, 'detailed', 1.0))
            found |= {
                f'5.1 {row.controller} {name}': getattr(metrics, name) for name in row.figures()
            }
            times[row.label] = metrics.engagement_time_s or math.inf
    return found | {'5.1 slowest': max(times, key=lambda label: times[label])}


def _table_5_2() -> dict[str, float | str | None]:
    runs = {
        (name, wear): thesis_run(name, WORN_ARCHITECTURE, wear)
        for name in _COMPARED
        for wear in WORN
    }
    end = steps_in('score_window_s', THESIS_SCENARIO.score_window_s[1])
    found: dict[str, float | str | None] = {}
    for (name, wear_gain), run in runs.items():
        slip = abs(float(run.slip_speed[end]))
        found[f'5.2 {name} w_d {wear_gain:g}'] = 'good' if slip < GOOD_SLIP_RAD_S else 'bad'
    torsion = {
        name: _metrics(runs[name, WORN[0]]).torsion_speed_std_rpm or 0.0 for name in _COMPARED
    }
    highest = max(torsion.values())
    return found | {
        f'5.2 {name} w_sr {WORN[0]:g}': 'high' if std == highest else 'low'
        for name, std in torsion.items()
    }


def _metrics(trajectory: Trajectory) -> Metrics:
    return compute_metrics(
        trajectory,
        control_start_s=THESIS_SCENARIO.control_start_s,
        score_window_s=THESIS_SCENARIO.score_window_s,
    )
