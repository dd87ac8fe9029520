"""What we compute for the numbers that need the closed loop: Tables 5.1 and 5.2, and claims."""

from collections.abc import Mapping

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.reproduction.numbers.thesis_number import Finding, Value
from ddct_bringup.reproduction.runs import (
    THESIS_SCENARIO,
    metrics_of,
    table_figures,
    thesis_metrics,
    thesis_run,
)
from ddct_bringup.reproduction.values.claims import claim_values
from ddct_bringup.reproduction.values.orders import CLEARLY, is_extreme, judge_words, text
from ddct_bringup.reproduction.values.plant_values import deviation_bound_percent
from ddct_bringup.scores.metrics import Metrics
from ddct_bringup.thesis.table_5_1 import THESIS_TABLE
from ddct_plant.base.timebase import steps_in
from ddct_plant.scenario.settings import RunSettings

WORN = (0.7, 1.3)
"""The two critical values of K_usura, inequality (3.2)."""
WORN_ARCHITECTURE = 'feedforward'
"""That of Figure 5.1, the only run with a worn clutch that the thesis shows."""
SLIP_WORDS = {'ls8': 'bad', 'hinf2': 'good', 'mpc3': 'bad', 'mpc4': 'average'}
"""Table 5.2: w_d, at both values of K_usura."""
OSCILLATION_WORDS = {
    0.7: {'ls8': 'high', 'hinf2': 'low', 'mpc3': 'average', 'mpc4': 'average'},
    1.3: dict.fromkeys(SLIP_WORDS, 'average'),
}
"""Table 5.2: w_sr and A_x by K_usura."""
NOT_REACHED = 'not reached'
"""In the place of t_a when w_d does not become 0."""
Figures = Mapping[str, float | None]
"""One figure by controller, None where it does not exist."""
_EQUAL_MODELS_PERCENT = 1.0
"""Share of the peak of w_d. Models that are nearer to each other count as equal."""


def closed_loop_values() -> dict[str, Value | None]:
    """Return the values by the ids that the thesis gate's files give them."""
    bound = deviation_bound_percent()
    models = Finding(bound <= _EQUAL_MODELS_PERCENT, f'within {bound:g} % of the peak')
    return {'1.5.1 models': models, **claim_values(), **_table_5_1(), **_table_5_2()}


def _table_5_1() -> dict[str, Value | None]:
    found: dict[str, Value | None] = {}
    for row in THESIS_TABLE:
        figures = table_figures(thesis_metrics(thesis_run(row.controller, 'detailed', 1.0)))
        if figures['engagement_time_s'] is None:
            figures['engagement_time_s'] = NOT_REACHED
        found |= {f'5.1 {row.controller} {name}': value for name, value in figures.items()}
    return found


def _table_5_2() -> dict[str, Value | None]:
    found: dict[str, Value | None] = {}
    ends = {}
    for wear in WORN:
        settings = RunSettings(THESIS_SCENARIO, WORN_ARCHITECTURE, wear_gain=wear)
        runs = {name: thesis_run(name, WORN_ARCHITECTURE, wear) for name in SLIP_WORDS}
        ends[wear], _, findings = judge_table_5_2(settings, runs)
        found |= findings
    return found | {'5.1 robust': _only_robust('hinf2', ends)}


def figures_of_table_5_2(
    settings: RunSettings, runs: Mapping[str, Trajectory]
) -> tuple[dict[str, float], dict[str, Metrics]]:
    """Return by controller |w_d| at the end of the score window in rad/s, and the metrics."""
    end = steps_in('score_window_s', settings.scenario.score_window_s[1])
    slips = {name: abs(float(run.slip_speed[end])) for name, run in runs.items()}
    return slips, {name: metrics_of(settings, run) for name, run in runs.items()}


def judge_table_5_2(
    settings: RunSettings, runs: Mapping[str, Trajectory]
) -> tuple[dict[str, float], dict[str, Metrics], dict[str, Finding]]:
    """Return by controller |w_d| at the end in rad/s and metrics; by the gate's ids the words."""
    slips, metrics = figures_of_table_5_2(settings, runs)
    twist = {name: one.torsion_speed_std_rpm for name, one in metrics.items()}
    acceleration = {name: one.acceleration_std_m_s2 for name, one in metrics.items()}
    return slips, metrics, findings_of_table_5_2(settings.wear_gain, slips, twist, acceleration)


def findings_of_table_5_2(
    wear_gain: float, slips: Figures, twist: Figures, acceleration: Figures
) -> dict[str, Finding]:
    """Return what the printed words come to, by the gate's ids, of |w_d|, w_sr and A_x."""
    words = {
        'w_d': judge_words(SLIP_WORDS, [('rad/s', slips)]),
        'w_sr': judge_words(
            OSCILLATION_WORDS[wear_gain], [('rpm', twist), ('m/s^2', acceleration)]
        ),
    }
    return {
        f'5.2 {name} {what} {wear_gain:g}': finding
        for what, found in words.items()
        for name, finding in found.items()
    }


def _only_robust(name: str, ends: dict[float, dict[str, float]]) -> Finding:
    """Return whether one controller ends clearly nearer to zero at both values of K_usura."""
    figures = '; '.join(f'K_usura {wear:g}: {text("rad/s", row)}' for wear, row in ends.items())
    return Finding(is_extreme(name, min, ends.values(), CLEARLY), figures)
