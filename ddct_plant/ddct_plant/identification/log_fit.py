"""The driveline of a measured car from its log, with intervals, and what it then predicts."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.identification.log_model import Stretch, residuals_of
from ddct_plant.identification.log_problem import DAMPINGS, LogProblem, NoiseModel, whiteness
from ddct_plant.identification.log_stretches import (
    KnownLoad,
    stretches_of,
    torques_are_noisy,
    with_more_torque_noise,
)
from ddct_plant.measured.log import SPEEDS, MeasuredLog
from ddct_plant.models.parameters import DrivelineParameters

PARAMETERS = tuple(vars(DrivelineParameters()))
SIGMAS_95 = 1.96
DETERMINED = 0.25
"""Largest relative standard deviation of a parameter that a log determines."""
DAMPING_DETERMINED = 0.05
"""The same of a damping, over the torque per speed of the log."""
RATIOS = (1.5, 60.0)
"""Total ratios that gearbox and final drive of a car or truck can have."""
_ROLLING = 1.0
"""Wheel speed in rad/s from which the ratio of the speeds says something."""
PULLED = 0.4
"""Share of these by which the noise of the torques may move a parameter."""
_MORE_NOISE = 4
"""How often the noise of the torques is doubled to see what it does to the fit."""
WHITE_FROM = 0.01
"""Smallest p-value of residuals that count as white."""


@dataclass(frozen=True)
class LogFit:
    """What a log says of the driveline."""

    values: dict[str, float]
    """Values of all parameters, fitted or held. A fitted damping may be below 0."""
    std: dict[str, float]
    """Standard deviation of each fitted one: of the value of a damping, else relative."""
    undetermined: tuple[str, ...]
    """Those that the log does not determine; they keep the value of the start."""
    noise: NoiseModel
    load_torque: float | None
    """Mean of the constants that were fitted as C_load, in N m; None where it was measured."""

    @property
    def parameters(self) -> DrivelineParameters:
        """The values, dampings below 0 as 0."""
        return DrivelineParameters(**{name: max(each, 0.0) for name, each in self.values.items()})

    def interval(self, name: str) -> tuple[float, float] | None:
        """Return the ends of the 95 % interval of a fitted parameter, None of one that is held."""
        if name not in self.std:
            return None
        value, reach = self.values[name], SIGMAS_95 * self.std[name]
        if name in DAMPINGS:
            return value - reach, value + reach
        return value * float(np.exp(-reach)), value * float(np.exp(reach))


def fit_log(
    log: MeasuredLog,
    start: DrivelineParameters,
    known_load: KnownLoad,
    fixed: Sequence[str] = (),
) -> LogFit:
    """
    Fit the driveline to a log; `fixed` parameters keep the value of `start`.

    White noise of the torques pulls a fit aside, as it is no torque of the car. So it is fitted
    again with that noise doubled; what moves is moved back, and counts as a deviation (simulation
    and extrapolation, Cook and Stefanski 1994). What the log does not determine is held, and
    named. Raise DdctError when that is all, or when the fit does not converge.
    """
    stretches = stretches_of(log, known_load)
    if 'total_ratio' not in fixed:
        start = replace(start, total_ratio=_ratio(log, stretches))
    noisier = [
        stretches_of(with_more_torque_noise(log, seed), known_load)
        for seed in range(_MORE_NOISE)
        if torques_are_noisy(log)
    ]
    free = [name for name in PARAMETERS if name not in fixed]
    weak: list[str] = []
    while len(weak) < len(free):
        problem = LogProblem(stretches, start, [name for name in free if name not in weak])
        x, covariance = problem.solve()
        moved = problem.moved_by(x, noisier) if noisier else np.zeros(len(x))
        std = np.sqrt(np.diag(covariance) + moved**2)
        of_each = zip(problem.free, std, np.abs(moved), strict=True)
        found = [name for name, *size in of_each if _is_weak(name, *size)]
        if not found:
            return _result(problem, x - moved, std, weak, stretches)
        weak += found
    raise DdctError(
        f'{log.path}: the log determines none of {", ".join(free)}: take one in which torques and '
        'speeds change'
    )


def _ratio(log: MeasuredLog, stretches: Sequence[Stretch]) -> float:
    """Return w_p over w_r; raise DdctError where no gearbox has that."""
    speeds = np.vstack([each.speeds for each in stretches])
    rolling = speeds[np.abs(speeds[:, 2]) > _ROLLING]
    ratio = float(np.median(rolling[:, 1] / rolling[:, 2])) if len(rolling) else math.nan
    if not RATIOS[0] <= ratio <= RATIOS[1]:
        raise DdctError(
            f'{log.path}: shaft_speed over wheel_speed is {ratio:.4g} as a rule, a car has '
            f'{RATIOS[0]:g} to {RATIOS[1]:g}: check both units, or give --fix total_ratio'
        )
    return ratio


def _is_weak(name: str, std: float, moved: float) -> bool:
    """Say whether a parameter is too uncertain, or pulled too far to be moved back on a line."""
    most = DAMPING_DETERMINED if name in DAMPINGS else DETERMINED
    return std > most or moved > PULLED * most


def _result(
    problem: LogProblem,
    x: np.ndarray,
    std: np.ndarray,
    weak: Sequence[str],
    stretches: Sequence[Stretch],
) -> LogFit:
    """Return the fit with deviations in the units of the parameters."""
    values = problem.values(x)
    loads = [residuals_of(values, each)[1][-1] for each in stretches if not each.load_known]
    lengths = [len(each.time_s) for each in stretches if not each.load_known]
    scales = {name: problem.damping if name in DAMPINGS else 1.0 for name in problem.free}
    return LogFit(
        values=values,
        std={n: scales[n] * each for n, each in zip(problem.free, std.tolist(), strict=True)},
        undetermined=tuple(weak),
        noise=problem.noise,
        load_torque=float(np.average(loads, weights=lengths)) if loads else None,
    )


@dataclass(frozen=True)
class Prediction:
    """One speed of the data that were held out, beside what the fitted driveline makes of it."""

    signal: str
    rms_rad_s: float
    """R.m.s. of measured less predicted."""
    nrmse: float | None
    """The same over the standard deviation of what was measured; None where it is constant."""
    whiteness_p: float | None
    """p of Ljung and Box for the residuals behind the fit's noise model; None for the slip."""

    @property
    def white(self) -> bool | None:
        """Whether nothing but noise is left, as far as the test shows; None where not tested."""
        return None if self.whiteness_p is None else self.whiteness_p >= WHITE_FROM


def predict(fit: LogFit, stretches: Sequence[Stretch]) -> list[Prediction]:
    """
    Return the prediction of w_m, w_p, w_r and of the slip w_m - w_p.

    The speeds at the start of each stretch, and its C_load where it was not measured, are fitted
    to it, the driveline is not.
    """
    left = [residuals_of(fit.values, each)[0] for each in stretches]
    p_values = whiteness([fit.noise.white(each) for each in left])
    measured, residual = (
        np.column_stack([speeds, speeds[:, 0] - speeds[:, 1]])
        for speeds in (np.vstack([each.speeds for each in stretches]), np.vstack(left))
    )
    rms = np.sqrt(np.mean(residual**2, axis=0)).tolist()
    spreads = np.std(measured, axis=0).tolist()
    rows = zip((*SPEEDS, 'slip_speed'), rms, spreads, (*p_values, None), strict=True)
    return [
        Prediction(name, size, size / spread if spread else None, p_value)
        for name, size, spread, p_value in rows
    ]
