# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The identification: what it finds, how sure it is, and that the defaults are its result."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from refusals import refused

from ddct_bringup.identification.checks import (
    check_identification,
    parameter_ranges,
    smallest_worst_residual,
)
from ddct_bringup.identification.coefficients import (
    FITTED,
    PrintedCoefficients,
    computed_coefficients,
    with_fitted,
)
from ddct_bringup.identification.fit import (
    Identification,
    identify_driveline,
    predict_left_out,
)
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import (
    CLUTCH_TO_SLIP,
    CLUTCH_TO_SLIP_AS_PRINTED,
    ENGINE_TO_SLIP,
    LOAD_TO_SLIP,
    PrintedTransferFunction,
)

pytestmark = pytest.mark.slow

COEFFICIENTS = PrintedCoefficients(CLUTCH_TO_SLIP, LOAD_TO_SLIP)
DEFAULT_DIGITS = 8
"""Significant digits of the default parameters."""


@cache
def best_fit() -> Identification:
    """Return the fit of the packaged problem."""
    return identify_driveline()


def round_significant(value: float, digits: int) -> float:
    """Return `value` rounded to `digits` significant digits."""
    return float(f'{value:.{digits - 1}e}')


def test_default_parameters_are_what_the_identification_derives():
    defaults = DrivelineParameters().values()
    for name, derived in best_fit().parameters.values().items():
        default = defaults[name]
        last_digit = 10.0 ** (
            math.floor(math.log10(derived)) - DEFAULT_DIGITS + 1 if derived else 0
        )
        assert abs(default - derived) <= 0.51 * last_digit, name
        assert default == round_significant(default, DEFAULT_DIGITS), name


def test_rounding_of_the_defaults_moves_no_coefficient_by_a_hundredth_of_its_print_rounding():
    defaults = DrivelineParameters().values()
    default = np.log([defaults[name] for name in FITTED])
    shift = COEFFICIENTS.residuals(default) - best_fit().residuals
    assert np.abs(shift).max() < 0.01


def test_every_coefficient_is_met_to_1_1_half_units_of_its_last_digit():
    assert len(best_fit().coefficients) == 9
    assert np.abs(best_fit().residuals).max() < 1.1
    for fit, (name, number) in zip(best_fit().coefficients, COEFFICIENTS.numbers, strict=True):
        assert (fit.transfer_function, fit.coefficient) == (name, number.label)
        residual = (fit.computed - float(fit.taken)) / number.half_unit
        assert residual == pytest.approx(fit.residual_half_units, abs=1e-9)


def test_identified_inertia_gives_the_printed_p1():
    gain = 1.0 / best_fit().parameters.engine_inertia
    assert abs(gain - float(ENGINE_TO_SLIP.gain)) < 2.0 * gain * best_fit().relative_std[0]
    assert best_fit().parameters.engine_damping == 0.0


def test_parameters_lie_within_a_thousandth_of_the_rounded_values_known_for_this_driveline():
    known = (0.25, 0.010057, 0.0120, 105.0, 6720.0, 9.344, 154.7)
    values = best_fit().parameters.values()
    found = [values[name] for name in FITTED]
    np.testing.assert_allclose(found, known, rtol=1e-3)


def test_fit_is_as_good_as_rounding_allows():
    assert best_fit().degrees_of_freedom == 2
    assert best_fit().chi_square == pytest.approx(3.556, abs=0.001)
    worst, _ = smallest_worst_residual(COEFFICIENTS, best_fit().logarithms)
    assert all(check.passed for check in check_identification(best_fit(), COEFFICIENTS, worst))


def test_334_4_fits_no_driveline_and_339_4_is_what_the_others_predict():
    coefficients = PrintedCoefficients(CLUTCH_TO_SLIP_AS_PRINTED)
    misprinted = identify_driveline(coefficients)
    worst, _ = smallest_worst_residual(coefficients, misprinted.logarithms)
    assert np.abs(misprinted.residuals).max() == pytest.approx(59.4, abs=0.1)
    assert misprinted.chi_square > 1e4
    assert not any(check.passed for check in check_identification(misprinted, coefficients, worst))
    predicted, std = predict_left_out(COEFFICIENTS, 'P2', 'zero c')
    assert predicted == pytest.approx(339.392, abs=0.001)
    assert std == pytest.approx(0.024, abs=0.001)


def test_leaving_out_a_gain_leaves_a_parameter_free_and_is_an_error():
    with refused(DdctError, 'P2'):
        predict_left_out(COEFFICIENTS, 'P2', 'gain')
    with refused(DdctError, 'P3'):
        predict_left_out(COEFFICIENTS, 'P3', 'pole z')


def test_optimum_does_not_depend_on_where_the_search_starts(monkeypatch):
    start = COEFFICIENTS.start()
    for seed in range(4):
        elsewhere = start + np.random.default_rng(seed).normal(0.0, 0.5, len(FITTED))
        monkeypatch.setattr(PrintedCoefficients, 'start', lambda self, at=elsewhere: at)
        np.testing.assert_allclose(
            identify_driveline().logarithms, best_fit().logarithms, atol=1e-8
        )


def test_closed_form_start_is_within_a_thousandth_of_the_fit():
    np.testing.assert_allclose(COEFFICIENTS.start(), best_fit().logarithms, atol=1e-3)


def test_exact_coefficients_give_back_the_driveline_they_came_from():
    true = DrivelineParameters(0.18, 0.0, 0.02, 0.05, 80.0, 9000.0, EngagedGear(12.0), 200.0)
    p2, p3 = printed_as(computed_coefficients(true), 15, 15)
    fit = identify_driveline(PrintedCoefficients(p2, p3))
    for name in FITTED:
        assert fit.parameters.values()[name] == pytest.approx(true.values()[name], rel=1e-8)


def printed_as(
    values: np.ndarray, gain_digits: int, digits: int
) -> tuple[PrintedTransferFunction, PrintedTransferFunction]:
    """Return P2 and P3 with the nine coefficients `values`, printed to so many digits."""
    gain, z_a, z_b, z_c, p_a, p_b, p_c, gain_3, corner = (
        f'{value:.{(gain_digits if number.label == "gain" else digits) - 1}e}'
        for value, (_, number) in zip(values, COEFFICIENTS.numbers, strict=True)
    )
    poles = (p_a, (p_b, p_c))
    return (
        PrintedTransferFunction('P2', gain, (z_a, (z_b, z_c)), ('0', *poles)),
        PrintedTransferFunction('P3', gain_3, (corner,), poles),
    )


def rounded_drivelines(
    count: int,
) -> list[tuple[np.ndarray, PrintedTransferFunction, PrintedTransferFunction]]:
    """Return logarithms near the fit, and P2 and P3 rounded to the thesis's 5 and 4 digits."""
    spread = np.random.default_rng(11).normal(0.0, 0.01, (count, len(FITTED)))
    return [
        (truth, *printed_as(computed_coefficients(with_fitted(truth)), 5, 4))
        for truth in best_fit().logarithms + spread
    ]


def test_stated_deviations_are_the_spread_over_drivelines_rounded_like_the_print():
    errors = []
    for truth, p2, p3 in rounded_drivelines(40):
        fit = identify_driveline(PrintedCoefficients(p2, p3))
        errors.append((fit.logarithms - truth) / fit.relative_std)
    spread = np.sqrt(np.mean(np.square(errors), axis=0))
    assert np.all((spread > 0.7) & (spread < 1.35)), spread


def test_ranges_hold_every_driveline_that_rounds_to_the_print():
    for truth, p2, p3 in rounded_drivelines(2):
        coefficients = PrintedCoefficients(p2, p3)
        worst, centre = smallest_worst_residual(coefficients, coefficients.start())
        assert worst <= 1.0
        ranges = parameter_ranges(coefficients, centre)
        assert np.all(ranges[:, 0] <= np.exp(truth))
        assert np.all(np.exp(truth) <= ranges[:, 1])


def test_one_driveline_rounds_to_all_nine_printed_numbers():
    worst, logarithms = smallest_worst_residual(COEFFICIENTS, best_fit().logarithms)
    assert worst == pytest.approx(0.810, abs=0.001)
    for value, (_, number) in zip(
        computed_coefficients(with_fitted(logarithms)), COEFFICIENTS.numbers, strict=True
    ):
        digits = 4 if number.label == 'gain' else 3
        assert float(f'{value:.{digits}e}') == number.value, number.label


def test_ends_of_the_ranges_are_in_the_set_and_further_out_is_not():
    _, centre = smallest_worst_residual(COEFFICIENTS, best_fit().logarithms)
    ranges = parameter_ranges(COEFFICIENTS, centre)
    values = best_fit().parameters.values()
    found = np.array([values[name] for name in FITTED])
    assert np.all(ranges[:, 0] < found) and np.all(found < ranges[:, 1])
    np.testing.assert_array_less(ranges[:, 1] - ranges[:, 0], 8 * found * best_fit().relative_std)


def test_transfer_functions_with_different_poles_are_refused():
    other = replace(LOAD_TO_SLIP, denominator=('0.1', ('121.4', '7696')))
    with pytest.raises(ParameterError, match='P2 and P3 must share their poles'):
        PrintedCoefficients(CLUTCH_TO_SLIP, other)
