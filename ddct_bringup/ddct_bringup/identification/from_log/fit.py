# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Fit driveline parameters and the delays of the signals to the log of a drive."""

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ddct_bringup.identification.from_log.perturbed import (
    half_of_the_rows,
    rounded_again,
    with_more_noise,
)
from ddct_bringup.identification.from_log.problem import LogProblem, used
from ddct_bringup.identification.from_log.response import residuals_of
from ddct_bringup.identification.from_log.result import SLIP, LogFit
from ddct_bringup.identification.from_log.stretches import (
    INPUTS,
    OUTPUTS,
    TORQUES,
    KnownLoad,
    Stretch,
    stretches_of,
)
from ddct_bringup.identification.from_log.unknowns import (
    DELAY_S,
    DELAYED,
    PARAMETERS,
    REFERENCE,
    Unknowns,
)
from ddct_bringup.logs.log import SPEEDS, MeasuredLog
from ddct_plant.base.errors import DdctError
from ddct_plant.models.gearbox import RATIOS_OF_CARS, EngagedGear
from ddct_plant.models.parameters import DrivelineParameters

_ROLLING = 1.0
"""Least wheel speed in rad/s for an estimate of the ratio of the speeds."""
_LATER = 0.02
"""
Deviation of the delay of an interpolated torque, over the step of its rows.

The torque of our own actuator is 0.02 steps later than straight lines between rows of 10 ms.
"""


def fit_log(
    log: MeasuredLog,
    start: DrivelineParameters,
    known_load: KnownLoad,
    fixed: Sequence[str] = (),
    known_delays: Mapping[str, float] | None = None,
    evaluated: Callable[[], None] = lambda: None,
) -> LogFit:
    """
    Fit driveline and delays to a log; `fixed` parameters keep the value of `start`.

    `known_delays` are the delays in s, by quantity, that are not fitted. That of the engine speed
    is 0 if it is not given: the others are relative to it. `evaluated` is called at each
    evaluation of the residuals, of which a fit has hundreds to thousands.

    The torques of a log are not quite those of the car: they have noise, they are rounded, and
    nobody knows them between their rows. Each biases a fit. So it is repeated with more of each,
    and what moves then is extrapolated back, and counts as a deviation (simulation and
    extrapolation, Cook and Stefanski 1994). So does the scatter over the repetitions. What coarser
    rounding moves counts in full: a fit has taken in a part of such errors before. Numbers that
    the log does not determine keep their start value, and are listed.
    Raise DdctError when no number is determined, or when the fit does not converge.
    """
    known_delays, stretches = known_delays or {}, stretches_of(log, known_load)
    if 'total_ratio' not in fixed:
        start = start.in_gear(_gear(log, stretches))
    signals = [name for name in DELAYED if name in log.signals]
    reference = known_delays.get(REFERENCE, 0.0)
    delays = dict.fromkeys((REFERENCE, *signals), reference) | dict(known_delays)
    noisier, thinner, coarser = (
        [stretches_of(each, known_load) for each in logs]
        for logs in (with_more_noise(log), half_of_the_rows(log), rounded_again(log))
    )
    free = [name for name in PARAMETERS if name not in fixed]
    free += [name for name in signals if name not in known_delays]
    weak: list[str] = []
    while len(weak) < len(free):
        names = [name for name in free if name not in weak]
        unknowns = Unknowns(names, start.values() | delays, _torque_per_speed(stretches))
        problem = LogProblem(unknowns, stretches, evaluated)
        x, by_speeds = problem.solve()
        by_noise, variance = _mean_and_variance(problem.moves(x, noisier))
        thinned, _ = _mean_and_variance(problem.moves(x, thinner))
        # Half of the rows have twice the noise in each second, too. The error of a torque that
        # jumps between rows grows with their step: all of the rest is that of jumps.
        between = thinned - by_noise if thinner else 0.0 * x
        by_rounding, scatter = _mean_and_variance(problem.moves(x, coarser))
        std = np.sqrt(by_speeds + variance + scatter)
        std = np.sqrt(std**2 + by_noise**2 + between**2 + by_rounding**2)
        # That of corners grows with the square, so a third is theirs. Corners on rows make none:
        # half of that is moved back.
        moved = by_noise + between / 6.0 + by_rounding
        found = unknowns.not_determined(std, moved)
        if not found:
            std = np.hypot(std, [_lateness(log, name) / DELAY_S for name in names])
            return _result(unknowns, x - moved, std, weak, stretches)
        weak += found
    raise DdctError(
        f'the log determines none of {", ".join(free)}: take one in which torques and '
        'speeds change',
        place=log.path,
    )


def _mean_and_variance(steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean step, and the variance of one step beside it; (n,) each, 0 without steps."""
    if not len(steps):
        return np.zeros(steps.shape[1]), np.zeros(steps.shape[1])
    return steps.mean(axis=0), steps.var(axis=0, ddof=1) * (1.0 + 1.0 / len(steps))


def _lateness(log: MeasuredLog, name: str) -> float:
    """Return the deviation in s of the delay of an interpolated torque; 0 of other numbers."""
    return 0.0 if name not in INPUTS or name in log.held else _LATER * log.usual_step(name)


def _torque_per_speed(stretches: Sequence[Stretch]) -> float:
    """Return the r.m.s. of C_m and C_f over that of w_m and w_p, in N m s/rad."""
    driving, damped = INPUTS.places(*TORQUES), OUTPUTS.places('engine_speed', 'shaft_speed')
    torques = np.concatenate([each.torques[:, driving].ravel() for each in stretches])
    speeds = np.concatenate([each.speeds[:, damped].ravel() for each in stretches])
    return float(np.sqrt(np.mean(torques**2) / np.mean(speeds**2)))


def _gear(log: MeasuredLog, stretches: Sequence[Stretch]) -> EngagedGear:
    """Return the gear of the median of w_p over w_r; raise DdctError where no car has it."""
    speeds = np.vstack([each.speeds for each in stretches])
    shaft, wheel = speeds[:, OUTPUTS.places('shaft_speed', 'wheel_speed')].T
    rolling = np.abs(wheel) > _ROLLING
    ratio = float(np.median(shaft[rolling] / wheel[rolling])) if rolling.any() else math.nan
    least, most = RATIOS_OF_CARS
    if not least <= ratio <= most:
        raise DdctError(
            f'shaft_speed over wheel_speed is {ratio:.4g} as a rule, a car has '
            f'{least:g} to {most:g}: check both units, or give --fix total_ratio',
            place=log.path,
        )
    return EngagedGear(ratio)


def _result(
    unknowns: Unknowns,
    x: np.ndarray,
    std: np.ndarray,
    weak: Sequence[str],
    stretches: Sequence[Stretch],
) -> LogFit:
    """Return the fit with its deviations in the units of the parameters."""
    values, deviations = unknowns.values(x), unknowns.deviations(std)
    stretches = used(stretches, values)
    loads = [residuals_of(values, each)[1][-1] for each in stretches if not each.load_known]
    lengths = [len(each.time_s) for each in stretches if not each.load_known]
    speeds = np.vstack([np.column_stack([each.speeds, each.slip]) for each in stretches])
    return LogFit(
        values={name: values[name] for name in PARAMETERS},
        std={name: each for name, each in deviations.items() if name in PARAMETERS},
        delays={name: each for name, each in values.items() if name in (REFERENCE, *DELAYED)},
        delay_std={name: each for name, each in deviations.items() if name in DELAYED},
        undetermined=tuple(weak),
        spreads=dict(zip((*SPEEDS, SLIP), speeds.std(axis=0).tolist(), strict=True)),
        load_torque=float(np.average(loads, weights=lengths)) if loads else None,
    )
