"""
What we compute for the numbers of Chapter 5: Tables 5.1 and 5.2, and what they decide.

The program `design thesis` finds it through the entry-point group `ddct.thesis_numbers`, because
the closed loop is no part of ddct_controllers.
"""

import math

from ddct_bringup.scores.thesis_table import THESIS_TABLE, ThesisRow, thesis_row
from ddct_bringup.thesis.runs import THESIS_SCENARIO, thesis_metrics, thesis_run
from ddct_bringup.thesis.words import oscillation_word, slip_word
from ddct_plant.timebase import steps_in

WORN = (0.7, 1.3)
"""The two critical values of K_usura, inequality (3.2)."""
WORN_ARCHITECTURE = 'feedforward'
"""That of Figure 5.1, the only run with a worn clutch that the thesis shows."""
COMPARED = ('ls8', 'hinf2', 'mpc3', 'mpc4')
"""The controllers of Table 5.2."""
NOT_REACHED = 'not reached'
"""In the place of t_a when w_d does not become 0."""


def closed_loop_values() -> dict[str, float | str | None]:
    """Return the values by the ids that the thesis gate's file gives them."""
    return {'4.2 oscillations': _oscillations(), **_table_5_1(), **_table_5_2()}


def _oscillations() -> str:
    """Return how MPC3's printed sigmas are beside those of the previous chapters."""
    mpc, *previous = (_printed(name) for name in ('mpc3', 'ls8', 'hinf1'))
    better = all(
        mpc.torsion_speed_std_rpm < row.torsion_speed_std_rpm
        and mpc.acceleration_std_m_s2 < row.acceleration_std_m_s2
        for row in previous
    )
    return 'better' if better else 'not better'


def _printed(controller: str) -> ThesisRow:
    row = thesis_row(controller)
    assert row is not None
    return row


def _table_5_1() -> dict[str, float | str | None]:
    found: dict[str, float | str | None] = {}
    times: dict[str, float] = {}
    for row in THESIS_TABLE:
        metrics = thesis_metrics(thesis_run(row.controller, 'detailed', 1.0))
        time = metrics.engagement_time_s
        found |= {f'5.1 {row.controller} {name}': getattr(metrics, name) for name in row.figures()}
        found[f'5.1 {row.controller} engagement_time_s'] = NOT_REACHED if time is None else time
        times[row.label] = math.inf if time is None else time
    return found | {'5.1 slowest': max(times, key=lambda label: times[label])}


def _table_5_2() -> dict[str, float | str | None]:
    found: dict[str, float | str | None] = {}
    for wear in WORN:
        runs = {name: thesis_run(name, WORN_ARCHITECTURE, wear) for name in COMPARED}
        slips = {name: abs(float(run.slip_speed[_end_step()])) for name, run in runs.items()}
        found |= {f'5.2 {name} w_d {wear:g}': slip_word(name, slips) for name in runs}
    # Where K_usura is 1.3 all words are `average`: there is nothing to compare them with.
    wear = WORN[0]
    worn = {name: thesis_metrics(thesis_run(name, WORN_ARCHITECTURE, wear)) for name in COMPARED}
    return found | {f'5.2 {name} w_sr {wear:g}': oscillation_word(name, worn) for name in worn}


def _end_step() -> int:
    return steps_in('score_window_s', THESIS_SCENARIO.score_window_s[1])
