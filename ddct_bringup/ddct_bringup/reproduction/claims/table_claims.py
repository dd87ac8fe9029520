"""What Chapters 5 and 6 say in words of the five controllers of Table 5.1, against our runs."""

from ddct_bringup.reproduction.claims.orders import (
    COMPARED,
    below,
    is_extreme,
    metric,
    sigma_text,
    sigmas,
    text,
)
from ddct_bringup.reproduction.numbers.thesis_number import Finding, Value
from ddct_bringup.thesis.table_5_1 import ThesisRow, thesis_row

_FREQUENCY, _PREDICTIVE = ('ls8', 'hinf1'), ('mpc3', 'mpc4')
_SIMILAR = 0.25
"""Relative distance within which two figures are similar: the tolerance of a prediction."""


def table_claim_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's files."""
    times, rows = metric('engagement_time_s', COMPARED), sigmas(COMPARED)
    of_time, of_all = text('s', times), sigma_text(rows, COMPARED)
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
    """Return how MPC3's printed sigmas are beside the printed ones of the chapters before."""
    mpc, *before = (_printed(name) for name in ('mpc3', *_FREQUENCY))
    better = all(
        mpc.torsion_speed_std_rpm < row.torsion_speed_std_rpm
        and mpc.acceleration_std_m_s2 < row.acceleration_std_m_s2
        for row in before
    )
    return 'better' if better else 'not better'


def _printed(controller: str) -> ThesisRow:
    row = thesis_row(controller)
    assert row is not None
    return row
