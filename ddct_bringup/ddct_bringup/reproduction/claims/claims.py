"""
What the thesis says in words of its architectures and of its MPC, held against our runs.

The rule of each claim stands in its entry of the gate's files: a strict order, or one by a factor.
"""

from ddct_bringup.reproduction.claims.orders import (
    CLEARLY,
    COMPARED,
    each_lower,
    is_extreme,
    metric,
    sigma_text,
    sigmas,
    text,
)
from ddct_bringup.reproduction.numbers.thesis_number import Finding, Value

LOOP_SHAPING = tuple(f'ls{number}' for number in range(1, 10))
H_INFINITY = ('hinf1', 'hinf2', 'hinf3')
PREDICTIVE = ('mpc1', 'mpc2', 'mpc3')
_ERROR = 'slip_rmse_rpm'


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
        '4.3 none': _mpc4_does_not_oscillate(),
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


def _mpc4_does_not_oscillate() -> Finding:
    rows = sigmas(COMPARED)
    return Finding(is_extreme('mpc4', min, rows, CLEARLY), sigma_text(rows, COMPARED))
