# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Fit driveline parameters and the delays of the signals to the log of a drive."""

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ddct_bringup.identification.from_log.delays import (
    BEND_OF,
    DELAYED,
    REFERENCE,
    residuals_by_name,
    without_ends,
)
from ddct_bringup.identification.from_log.dependence import Dependence, dependences
from ddct_bringup.identification.from_log.determined import not_determined
from ddct_bringup.identification.from_log.problem import LogProblem, nothing
from ddct_bringup.identification.from_log.result import PARAMETERS, SLIP, LogFit
from ddct_bringup.identification.from_log.stretch import (
    LOAD,
    SPEED_COLUMNS,
    TORQUES,
    Stretch,
    slip_of,
)
from ddct_bringup.identification.from_log.stretches import (
    KnownLoad,
    stretches_of,
    torques_are_noisy,
    with_more_torque_noise,
)
from ddct_bringup.logs.log import SPEEDS, MeasuredLog
from ddct_plant.base.errors import DdctError
from ddct_plant.models.gearbox import RATIOS_OF_CARS, EngagedGear
from ddct_plant.models.parameters import DrivelineParameters

_ROLLING = 1.0
"""Least wheel speed in rad/s for an estimate of the ratio of the speeds."""
_BENT = 0.02
"""
Standard deviation of the delay of an interpolated torque, over the step of its samples.

The torque of our own actuator is 0.02 steps later than linear interpolation of rows of 10 ms.
"""
_MORE_NOISE = 4
"""Number of fits with doubled noise of the torques, which measure its effect."""
_ALL_FITTED: Mapping[str, float] = {}
"""Known delays of a fit in which every delay is fitted."""


def fit_log(
    log: MeasuredLog,
    start: DrivelineParameters,
    known_load: KnownLoad,
    fixed: Sequence[str] = (),
    known_delays: Mapping[str, float] = _ALL_FITTED,
    evaluated: Callable[[], None] = nothing,
) -> LogFit:
    """
    Fit driveline and delays to a log; `fixed` parameters keep the value of `start`.

    `known_delays` are the delays in s, by quantity, that are not fitted. That of the engine speed
    is 0 if it is not given: the others are relative to it. `evaluated` is called at each
    evaluation of the residuals, of which a fit has hundreds to thousands.

    White noise of the torques biases a fit, as it is no torque of the car. So the fit is repeated
    with that noise doubled; the shift is subtracted, and counts as a deviation (simulation and
    extrapolation, Cook and Stefanski 1994). Numbers that the log does not determine keep their
    start value, and are listed. Raise DdctError when no number is determined, or when the fit does
    not converge.
    """
    stretches = stretches_of(log, known_load)
    if 'total_ratio' not in fixed:
        start = start.in_gear(_gear(log, stretches))
    noisier = [
        stretches_of(with_more_torque_noise(log, seed), known_load)
        for seed in range(_MORE_NOISE)
        if torques_are_noisy(log)
    ]
    signals = [name for name in DELAYED if name in log.signals]
    reference = known_delays.get(REFERENCE, 0.0)
    delays = dict.fromkeys((REFERENCE, *signals), reference) | dict(known_delays)
    free = [name for name in PARAMETERS if name not in fixed]
    free += [name for name in signals if name not in known_delays]
    bends = [f'{BEND_OF}{name}' for name in TORQUES if name not in log.held]
    weak: list[str] = []
    while len(weak) < len(free):
        fitted = [name for name in (*free, *bends) if name not in weak]
        problem = LogProblem(stretches, start, delays, fitted, evaluated)
        x, covariance, jacobian = problem.solve()
        moved = problem.moved_by(x, noisier) if noisier else np.zeros(len(x))
        std = np.sqrt(np.diag(covariance) + moved**2)
        found = not_determined(fitted, std, np.abs(moved))
        if not found:
            used = [problem.used(each) for each in (stretches, *noisier)]
            dependent = dependences(problem.values(x), problem.noise, used[0], jacobian, used[1:])
            deviations = problem.in_units(std) | _between(log, fitted, problem.in_units(std))
            return _result(problem, x - moved, deviations, weak, stretches, dependent)
        weak += found
    raise DdctError(
        f'the log determines none of {", ".join(free)}: take one in which torques and '
        'speeds change',
        place=log.path,
    )


def _between(
    log: MeasuredLog, fitted: Sequence[str], deviations: Mapping[str, float]
) -> dict[str, float]:
    """Return the deviations in s of the delays of linearly interpolated torques."""
    return {
        name: math.hypot(deviations[name], _BENT * log.usual_step(name))
        for name in (*TORQUES, LOAD)
        if name in fitted and name not in log.held
    }


def _gear(log: MeasuredLog, stretches: Sequence[Stretch]) -> EngagedGear:
    """Return the gear of the median of w_p over w_r; raise DdctError where no car has it."""
    speeds = np.vstack([each.speeds for each in stretches])
    shaft, wheel = speeds[:, SPEED_COLUMNS.places('shaft_speed', 'wheel_speed')].T
    rolling = np.abs(wheel) > _ROLLING
    ratios = shaft[rolling] / wheel[rolling]
    ratio = float(np.median(ratios)) if len(ratios) else math.nan
    least, most = RATIOS_OF_CARS
    if not least <= ratio <= most:
        raise DdctError(
            f'shaft_speed over wheel_speed is {ratio:.4g} as a rule, a car has '
            f'{least:g} to {most:g}: check both units, or give --fix total_ratio',
            place=log.path,
        )
    return EngagedGear(ratio)


def _result(
    problem: LogProblem,
    x: np.ndarray,
    deviations: Mapping[str, float],
    weak: Sequence[str],
    stretches: Sequence[Stretch],
    dependent: Sequence[Dependence],
) -> LogFit:
    """Return the fit with its deviations in the units of the parameters."""
    values = problem.values(x)
    stretches = without_ends(stretches, values)
    loads = [residuals_by_name(values, each)[1][-1] for each in stretches if not each.load_known]
    lengths = [len(each.time_s) for each in stretches if not each.load_known]
    return LogFit(
        values={name: values[name] for name in PARAMETERS},
        std={name: each for name, each in deviations.items() if name in PARAMETERS},
        delays={name: each for name, each in values.items() if name in (REFERENCE, *DELAYED)},
        delay_std={name: each for name, each in deviations.items() if name in DELAYED},
        bends={name: each for name, each in values.items() if name.startswith(BEND_OF)},
        undetermined=tuple(weak),
        noise=problem.noise,
        dependences=dict(zip(SPEEDS, dependent, strict=True)),
        spreads=_spreads(stretches),
        load_torque=float(np.average(loads, weights=lengths)) if loads else None,
    )


def _spreads(stretches: Sequence[Stretch]) -> dict[str, float]:
    speeds = np.vstack([each.speeds for each in stretches])
    spreads = np.column_stack([speeds, slip_of(speeds)]).std(axis=0).tolist()
    return dict(zip((*SPEEDS, SLIP), spreads, strict=True))
