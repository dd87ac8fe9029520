"""The whole calibration and its result as plain JSON content: what is printed, kept and tested."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ddct_bringup.reproduction.calibration.analysis import (
    FITTED_NUMBERS,
    LeftOut,
    identifiability,
    leave_one_row_out,
    vary_assumptions,
)
from ddct_bringup.reproduction.calibration.parameters import (
    BASE,
    LOWER,
    PARAMETERS,
    RANGE,
    TARGETS,
)
from ddct_bringup.reproduction.calibration.problem import Fit, Problem, fit
from ddct_bringup.reproduction.calibration.search import (
    LocalOptimum,
    Progress,
    require_stable_pi,
    rounded,
    search,
)
from ddct_bringup.thesis.table_5_1 import FIGURES, TOLERANCES
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.scenario import Scenario

Record = dict[str, Any]
NAMES = tuple(parameter.name for parameter in PARAMETERS)
RETURN_TOLERANCE = 0.01
"""How far, in shares of a parameter's range, a refit may move from the frozen scenario."""


def calibrate(progress: Progress) -> Record:
    """Run the whole calibration and return its record; raise DdctError without a stable PI."""
    found = search(progress)
    optimum = found.chosen.fit
    frozen = rounded(optimum.values)
    require_stable_pi(frozen)
    return {
        'objective': _objective(optimum),
        'score_window_s': [BASE.control_start_s, optimum.problem.window_end_s],
        'parameters': _parameters(optimum, frozen),
        'torque_and_slopes': _torque_and_slopes(optimum),
        'residuals': residual_rows(optimum.problem.figures(frozen)),
        'frozen_objective': _half_square(optimum.problem.residuals(frozen)),
        'windows': [_optimum(one) for one in found.windows],
        'starts': [_optimum(one) for one in found.starts],
        'identifiability': _identifiability(optimum),
        'left_out': [_left_out(one) for one in leave_one_row_out(optimum, progress)],
        'assumptions': [
            {'change': change, **_fit(one)}
            for change, one in vary_assumptions(optimum, progress).items()
        ],
    }


def check_frozen(scenario: Scenario, progress: Progress) -> Record:
    """
    Return the residuals of a calibrated scenario and where a local refit moves it.

    Raise DdctError when its PI does not stabilise the slip speed.
    """
    frozen = values_of(scenario)
    require_stable_pi(frozen)
    problem = Problem(scenario.score_window_s[1], base=scenario)
    progress('local refit')
    refit = fit(problem, frozen)
    return {
        'score_window_s': list(scenario.score_window_s),
        'residuals': residual_rows(problem.figures(frozen)),
        'frozen_objective': _half_square(problem.residuals(frozen)),
        'refit': _fit(refit),
        'moved': dict(zip(MOVES, _moved(frozen, refit.values), strict=True)),
    }


MOVES = ('torque_rise_n_m', *NAMES[2:])
"""What a refit is compared in: C_m end less C_m start, as the two alone are not determined."""


def _moved(frozen: Sequence[float], refit: Sequence[float]) -> list[float]:
    """Return the moves in shares of the ranges, in the order of MOVES."""
    change = np.subtract(refit, frozen)
    return [float(change[1] - change[0]) / RANGE[1], *(change[2:] / RANGE[2:]).tolist()]


def values_of(scenario: Scenario) -> tuple[float, ...]:
    """Return the (6,) values of PARAMETERS; raise ParameterError for another kind of scenario."""
    engine, gains = scenario.engine, scenario.controllers.get('pi', {})
    if len(engine.time_s) != 2 or engine.time_s[0] != 0.0 or not {*NAMES[4:]} <= {*gains}:
        raise ParameterError(
            f'scenario {scenario.name} is not of the calibrated kind: engine torque from 0 s in '
            'one straight rise, and both gains of pi'
        )
    return (
        *engine.torque_n_m,
        engine.time_s[1],
        scenario.reference.slope_rad_s2,
        *(gains[name] for name in NAMES[4:]),
    )


def residual_rows(figures: Mapping[str, Mapping[str, float]]) -> list[Record]:
    """Return one entry per figure of each row: printed, computed, deviation and tolerance."""
    return [
        {
            'row': row,
            'figure': name,
            'printed': TARGETS[row][name],
            'computed': computed[name],
            'deviation': computed[name] / TARGETS[row][name] - 1.0,
            'tolerance': TOLERANCES[name],
        }
        for row, computed in figures.items()
        for name in FIGURES
    ]


def outside_tolerance(rows: Sequence[Record]) -> list[str]:
    """Return what lies outside its tolerance, in words."""
    return [
        f'{entry["row"]} {entry["figure"]} {100.0 * entry["deviation"]:+.1f} %'
        for entry in rows
        if abs(entry['deviation']) > entry['tolerance']
    ]


def _objective(optimum: Fit) -> Record:
    return {
        'value': optimum.objective,
        'residual_tolerances': TOLERANCES,
        'numbers': len(optimum.residuals),
        'fitted': FITTED_NUMBERS,
    }


def _parameters(optimum: Fit, frozen: Sequence[float]) -> list[Record]:
    analysis = identifiability(optimum)
    return [
        {
            'name': parameter.name,
            'symbol': parameter.symbol,
            'unit': parameter.unit,
            'lower': parameter.lower,
            'upper': parameter.upper,
            'bounds_from': parameter.bounds_from,
            'value': optimum.values[index],
            'frozen': frozen[index],
            'at_bound': _at_bound(optimum.values[index], index),
            'std': float(analysis.std[index]),
            'std_given_start': float(analysis.std_given_start[index]) if index else None,
        }
        for index, parameter in enumerate(PARAMETERS)
    ]


def _torque_and_slopes(optimum: Fit) -> list[Record]:
    """Return levels, rise and slopes that the fit implies, with their standard errors."""
    analysis = identifiability(optimum)
    start, end, rise_end, slope = optimum.values[:4]
    rate = (end - start) / rise_end
    none = (0.0, 0.0)
    quantities = (
        ('C_m start', 'N m', start, (1.0, 0.0, 0.0, 0.0, *none)),
        ('C_m end', 'N m', end, (0.0, 1.0, 0.0, 0.0, *none)),
        ('rise of C_m', 'N m', end - start, (-1.0, 1.0, 0.0, 0.0, *none)),
        ('slope of C_m', 'N m/s', rate, (*np.divide((-1.0, 1.0, -rate), rise_end), 0.0, *none)),
        ('slope of the reference', 'rad/s^2', slope, (0.0, 0.0, 0.0, 1.0, *none)),
    )
    entries = []
    for quantity, unit, value, gradient in quantities:
        free, held = analysis.std_of(gradient)
        entries.append(
            {
                'quantity': quantity,
                'unit': unit,
                'value': value,
                'std': free,
                'std_given_start': held,
            }
        )
    return entries


def _at_bound(value: float, index: int) -> bool:
    share = (value - LOWER[index]) / RANGE[index]
    return bool(min(share, 1.0 - share) < 1e-3)


def _fit(one: Fit) -> Record:
    return {
        'objective': one.objective,
        'worst_residual': float(one.residuals[np.argmax(np.abs(one.residuals))]),
        'values': dict(zip(NAMES, one.values, strict=True)),
    }


def _optimum(one: LocalOptimum) -> Record:
    return {
        'window_end_s': one.fit.problem.window_end_s,
        'pi_kind': one.pi_kind,
        'pi_growth_rate_per_s': one.pi_growth_rate,
        'pi_stable': one.pi_stable,
        **_fit(one.fit),
    }


def _identifiability(optimum: Fit) -> Record:
    analysis = identifiability(optimum)
    return {
        'degrees_of_freedom': analysis.degrees_of_freedom,
        'residual_std': analysis.residual_std,
        'coverage_95': analysis.coverage_95,
        'singular_values': analysis.singular_values.tolist(),
        'directions': analysis.directions.tolist(),
        'weakest': dict(zip(NAMES, analysis.weakest.tolist(), strict=True)),
        'correlation_given_start': analysis.correlation_given_start.tolist(),
    }


def _left_out(one: LeftOut) -> Record:
    return {
        'row': one.row,
        'gains_from_row': one.gains_from_row,
        **_fit(one.fit),
        'figures': residual_rows({one.row: one.figures}),
    }


def _half_square(residuals: np.ndarray) -> float:
    return 0.5 * float(np.sum(residuals**2))
