# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Computed values for the numbers that need the closed loop: Tables 5.1 and 5.2, and claims.

The claims are the thesis's qualitative statements on its architectures and controllers. The rule
of each is in its entry of the gate's files: a strict order, or one by a factor.
"""

from collections.abc import Callable, Mapping
from functools import partial

from ddct_bringup.reproduction.numbers.thesis_number import Finding, Value
from ddct_bringup.reproduction.study_run import SLIP_ERROR, thesis_run
from ddct_bringup.reproduction.values.orders import (
    CLEARLY,
    SLIP_RATINGS,
    WORN,
    WORN_ARCHITECTURE,
    Row,
    below,
    each_lower,
    is_extreme,
    judge_table_5_2,
    metric,
    rows_of_table_5_2,
    sigma_text,
    sigmas,
    text,
)
from ddct_bringup.reproduction.values.plant_values import deviation_bound_percent
from ddct_bringup.thesis.table_5_1 import ROW_OF
from ddct_bringup.thesis.table_metrics import TABLE_METRICS

LOOP_SHAPING = tuple(f'ls{number}' for number in range(1, 10))
H_INFINITY = ('hinf1', 'hinf2', 'hinf3')
PREDICTIVE = ('mpc1', 'mpc2', 'mpc3')
NOT_REACHED = 'not reached'
"""Text in place of t_a when w_d does not become 0."""
_ERROR = SLIP_ERROR.key
_FREQUENCY, _PREDICTIVE = ('ls8', 'hinf1'), ('mpc3', 'mpc4')
_SIMILAR = 0.25
"""Relative distance within which two values are similar: the tolerance of a prediction."""
_EQUAL_MODELS_PERCENT = 1.0
"""Difference of models that count as equal, in % of the peak of w_d."""


def closed_loop_values() -> dict[str, Value | None]:
    """Return the values by the ids of the thesis gate's files."""
    bound = deviation_bound_percent()
    return {
        '1.5.1 models': Finding(bound <= _EQUAL_MODELS_PERCENT, f'within {bound:g} % of the peak'),
        **{name: judge() for name, judge in FIGURE_CLAIMS.items()},
        **_table_claims(),
        **_table_5_1(),
        **_table_5_2(),
    }


def _feedforward_better() -> Finding:
    after, before = (metric(_ERROR, LOOP_SHAPING, name) for name in ('feedforward', 'base'))
    return each_lower([after], [before])


def _only_hinf2_tracks() -> Finding:
    error = metric(_ERROR, H_INFINITY, 'base')
    return Finding(is_extreme('hinf2', min, [error], CLEARLY), text('rpm', error))


def _tracking_costs() -> Finding:
    twist, _ = sigmas(H_INFINITY, 'base')
    return Finding(is_extreme('hinf2', max, [twist], CLEARLY), text('rpm', twist))


def _detailed_reduces() -> Finding:
    return each_lower(sigmas(H_INFINITY), sigmas(H_INFINITY, 'feedforward'))


def _only_hinf2_is_bad() -> Finding:
    rows = sigmas(H_INFINITY)
    return Finding(is_extreme('hinf2', max, rows, CLEARLY), sigma_text(rows, H_INFINITY))


def _mpc4_has_no_oscillations() -> Finding:
    rows = sigmas(tuple(ROW_OF))
    return Finding(is_extreme('mpc4', min, rows, CLEARLY), sigma_text(rows, ROW_OF))


def _only_hinf2_is_robust() -> Finding:
    """Return whether Hinf2 alone ends clearly nearer to zero at both K_usura."""
    ends = {wear: _rows_of_table_5_2(wear)[0] for wear in WORN}
    figures = '; '.join(f'K_usura {wear:g}: {text("rad/s", row)}' for wear, row in ends.items())
    return Finding(is_extreme('hinf2', min, ends.values(), CLEARLY), figures)


def _tanh_no_better(controllers: tuple[str, ...]) -> Finding:
    tanh, ramp = (sigmas(controllers, name) for name in ('feedforward_tanh', 'feedforward'))
    return each_lower(tanh, ramp, expected=False)


def _faster_oscillates() -> Finding:
    error = metric(_ERROR, H_INFINITY, 'feedforward')
    twist, _ = sigmas(H_INFINITY, 'feedforward')
    by_error = sorted(H_INFINITY, key=error.__getitem__)
    by_twist = sorted(H_INFINITY, key=twist.__getitem__, reverse=True)
    return Finding(by_error == by_twist, f'error {text("rpm", error)}; w_sr {text("rpm", twist)}')


def _mpc_oscillates_less() -> Finding:
    before = (*LOOP_SHAPING, *H_INFINITY)
    rows = sigmas((*before, *PREDICTIVE))
    lowest = [min(before, key=row.__getitem__) for row in rows]
    less = all(
        row[name] < row[least]
        for row, least in zip(rows, lowest, strict=True)
        for name in PREDICTIVE
    )
    return Finding(less, sigma_text(rows, (*PREDICTIVE, *dict.fromkeys(lowest))))


def _table_claims() -> dict[str, Value | None]:
    """Return the values for claims on the five controllers of Table 5.1, by gate id."""
    times, rows = metric('engagement_time_s', ROW_OF), sigmas(tuple(ROW_OF))
    of_time, of_all = text('s', times), sigma_text(rows, ROW_OF)
    four = (*_FREQUENCY, *_PREDICTIVE)
    pairs = [(mpc, other) for mpc in _PREDICTIVE for other in _FREQUENCY]
    alike = all(abs(row['mpc3'] - row['hinf1']) <= _SIMILAR * row['hinf1'] for row in rows)
    return {
        '4.2 table': _printed_order(),
        '5.1 slowest': Finding(is_extreme('pi', max, [times]), of_time),
        '5.1 ls8 largest': Finding(is_extreme('ls8', max, rows), of_all),
        **{
            f'5.1 {name} damps': Finding(below(name, 'ls8', rows), sigma_text(rows, (name, 'ls8')))
            for name in ('mpc3', 'hinf1')
        },
        '5.1 similar': Finding(alike, sigma_text(rows, ('mpc3', 'hinf1'))),
        '5.1 mpc3 faster': Finding(below('mpc3', 'hinf1', [times]), of_time),
        '5.1 mpc4 fastest': Finding(is_extreme('mpc4', min, [times]), of_time),
        '5.1 best': Finding(is_extreme('mpc4', min, (times, *rows)), f't_a {of_time}; {of_all}'),
        '6 frequency': Finding(
            all(below(mpc, other, rows) for mpc, other in pairs), sigma_text(rows, four)
        ),
        '6 better': Finding(
            all(below(mpc, other, (times, *rows)) for mpc, other in pairs),
            f't_a {of_time}; {sigma_text(rows, four)}',
        ),
    }


def _printed_order() -> str:
    """Return the order of MPC3's printed sigmas relative to those of the earlier chapters."""
    better = all(
        ROW_OF['mpc3'].printed_values()[name] < ROW_OF[before].printed_values()[name]
        for before in _FREQUENCY
        for name in TABLE_METRICS[1:]
    )
    return 'better' if better else 'not better'


def _table_5_1() -> dict[str, Value | None]:
    found: dict[str, Value | None] = {}
    for controller in ROW_OF:
        figures = thesis_run(controller, 'detailed', 1.0).table_values
        found |= {f'5.1 {controller} {name}': value for name, value in figures.items()}
        if figures['engagement_time_s'] is None:
            found[f'5.1 {controller} engagement_time_s'] = NOT_REACHED
    return found


def _table_5_2() -> dict[str, Value | None]:
    """Return the ratings by gate id."""
    found: dict[str, Value | None] = {}
    for wear in WORN:
        found |= judge_table_5_2(wear, _rows_of_table_5_2(wear))
    return found


def _rows_of_table_5_2(wear: float) -> list[Row]:
    runs = {name: thesis_run(name, WORN_ARCHITECTURE, wear) for name in SLIP_RATINGS}
    return rows_of_table_5_2(runs)


FIGURE_CLAIMS: Mapping[str, Callable[[], Finding]] = {
    '2.4 feedforward': _feedforward_better,
    '2.5 tanh': partial(_tanh_no_better, LOOP_SHAPING),
    '3.3 tracks': _only_hinf2_tracks,
    '3.3 cost': _tracking_costs,
    '3.4 faster': _faster_oscillates,
    '3.5 tanh': partial(_tanh_no_better, H_INFINITY),
    '3.6 reduced': _detailed_reduces,
    '3.6 bad': _only_hinf2_is_bad,
    '4.2 runs': _mpc_oscillates_less,
    '4.3 none': _mpc4_has_no_oscillations,
    '5.1 robust': _only_hinf2_is_robust,
}
"""Checks of what the thesis says of its figures of runs, by gate id."""
