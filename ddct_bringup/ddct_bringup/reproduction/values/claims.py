"""
What the thesis says in words of its architectures and controllers, held against our runs.

The rule of each claim stands in its entry of the gate's files: a strict order, or one by a factor.
"""

from ddct_bringup.reproduction.numbers.thesis_number import Finding, Value
from ddct_bringup.reproduction.values.orders import (
    CLEARLY,
    COMPARED,
    below,
    each_lower,
    is_extreme,
    metric,
    sigma_text,
    sigmas,
    text,
)
from ddct_bringup.thesis.table_5_1 import FIGURES, ROW_OF

LOOP_SHAPING = tuple(f'ls{number}' for number in range(1, 10))
H_INFINITY = ('hinf1', 'hinf2', 'hinf3')
PREDICTIVE = ('mpc1', 'mpc2', 'mpc3')
_ERROR = 'slip_rmse_rpm'
_FREQUENCY, _PREDICTIVE = ('ls8', 'hinf1'), ('mpc3', 'mpc4')
_SIMILAR = 0.25
"""Relative distance within which two figures are similar: the tolerance of a prediction."""


def claim_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's files."""
    base = metric(_ERROR, H_INFINITY, 'base')
    twist, _ = sigmas(H_INFINITY, 'base')
    detailed = sigmas(H_INFINITY)
    return {
        '2.4 feedforward': each_lower(
            [metric(_ERROR, LOOP_SHAPING, 'feedforward')], [metric(_ERROR, LOOP_SHAPING, 'base')]
        ),
        '2.5 tanh': _tanh_no_better(LOOP_SHAPING),
        '3.3 tracks': Finding(is_extreme('hinf2', min, [base], CLEARLY), text('rpm', base)),
        '3.3 cost': Finding(is_extreme('hinf2', max, [twist], CLEARLY), text('rpm', twist)),
        '3.4 faster': _faster_oscillates(),
        '3.5 tanh': _tanh_no_better(H_INFINITY),
        '3.6 reduced': each_lower(detailed, sigmas(H_INFINITY, 'feedforward')),
        '3.6 bad': Finding(
            is_extreme('hinf2', max, detailed, CLEARLY), sigma_text(detailed, H_INFINITY)
        ),
        '4.2 runs': _mpc_oscillates_less(),
        **_table_claims(),
    }


def _tanh_no_better(controllers: tuple[str, ...]) -> Finding:
    tanh, ramp = (sigmas(controllers, name) for name in ('feedforward_tanh', 'feedforward'))
    return each_lower(tanh, ramp, wanted=False)


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
    """Return the values that the five controllers of Table 5.1 decide, by the ids of the files."""
    times, rows = metric('engagement_time_s', COMPARED), sigmas(COMPARED)
    of_time, of_all = text('s', times), sigma_text(rows, COMPARED)
    four = (*_FREQUENCY, *_PREDICTIVE)
    pairs = [(mpc, other) for mpc in _PREDICTIVE for other in _FREQUENCY]
    alike = all(abs(row['mpc3'] - row['hinf1']) <= _SIMILAR * row['hinf1'] for row in rows)
    return {
        '4.2 table': _printed_order(),
        '4.3 none': Finding(is_extreme('mpc4', min, rows, CLEARLY), of_all),
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
    """Return how MPC3's printed sigmas are beside the printed ones of the chapters before."""
    better = all(
        ROW_OF['mpc3'].figures()[name] < ROW_OF[before].figures()[name]
        for before in _FREQUENCY
        for name in FIGURES[1:]
    )
    return 'better' if better else 'not better'
