# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""From plant and weights to the generalised plant: mixed sensitivity, continuous and sampled."""

import numpy as np
import scipy

from ddct_controllers.design.h_infinity.synthesis.generalised_plant import (
    GeneralisedPlant,
)
from ddct_controllers.design.h_infinity.weights import stable_weight
from ddct_controllers.design.state_space import series
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace

AXIS_SHIFT_RAD_S = 1e-4
"""
Distance in rad/s by which a plant pole at 0 is moved to the left for the synthesis.

On the axis it is an invariant zero of the generalised plant, for which the Riccati equations have
no stabilising solution; anything from 1e-6 to 1e-3 gives the same gamma.
"""
_UNIT = StateSpace(np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.ones((1, 1)))


def mixed_sensitivity(
    plant: FactoredTransferFunction,
    w_1: FactoredTransferFunction,
    w_2: FactoredTransferFunction,
) -> GeneralisedPlant:
    """
    Return M with w = r, z = [W_1 e, W_2 y] and v = e = r - y, y = plant u (Section 3.1).

    `w_2` is a polynomial in s. It is exact, without the thesis's `sderiv`: y' = C A x and so on,
    up to the order at which u appears, which is the plant's relative degree. Raise ParameterError
    for a weight that cannot be used.
    """
    realised = off_axis(plant).to_state_space()
    weighted = _derivatives(realised, plant.poles.size - plant.zeros.size, w_2)
    return _stack(realised, weighted, (stable_weight('W_1', w_1), _UNIT))


def sampled_sensitivity(
    plant: StateSpace,
    w_1: FactoredTransferFunction,
    w_2: FactoredTransferFunction,
    effort: FactoredTransferFunction | None = None,
    disturbance_n_m: float = 0.0,
) -> GeneralisedPlant:
    """
    Return M for a plant in the w-plane, with z = [W_1 e, W_2 y, W_c u] and w = [r, d].

    The plant may have feedthrough. d is a torque of `disturbance_n_m` at the plant's input; it
    is left out where that is 0. All poles are moved left by `AXIS_SHIFT_RAD_S`.
    """
    shifted = plant.a - AXIS_SHIFT_RAD_S * np.eye(len(plant.a))
    moved = StateSpace(shifted, plant.b, plant.c, plant.d)
    named = {'W_1': w_1, 'W_2': w_2, 'W_c': effort}
    weights = tuple(stable_weight(name, weight) for name, weight in named.items() if weight)
    return _stack(moved, (plant.c, plant.d), weights, disturbance_n_m)


def off_axis(plant: FactoredTransferFunction) -> FactoredTransferFunction:
    """Return the plant with its poles at 0 moved to -`AXIS_SHIFT_RAD_S`."""
    moved = tuple(AXIS_SHIFT_RAD_S if factor == 0.0 else factor for factor in plant.denominator)
    found = FactoredTransferFunction(plant.gain, plant.numerator, moved)
    on_axis = found.poles[(found.poles.real == 0.0)]
    if on_axis.size:
        raise DdctError(
            f'plant has an undamped pole at {on_axis[0]:.4g} rad/s: give it a little damping for '
            'the synthesis'
        )
    return found


def _derivatives(
    plant: StateSpace, relative_degree: int, weight: FactoredTransferFunction
) -> tuple[np.ndarray, np.ndarray]:
    """Return the row (1, n) and feedthrough (1, 1) of weight(d/dt) y."""
    coefficients = weight.gain * np.atleast_1d(np.poly(weight.zeros).real)[::-1]
    degree = len(coefficients) - 1
    if degree > relative_degree:
        raise ParameterError(
            f'W_2 is of degree {degree}, but the plant has only {relative_degree} more poles than '
            f'zeros, so that W_2 T is improper: give it at most {relative_degree} zeros',
            key='W_2',
        )
    derivatives = [plant.c]
    for _ in range(degree):
        derivatives.append(derivatives[-1] @ plant.a)
    row = np.sum([c * d for c, d in zip(coefficients, derivatives, strict=True)], axis=0)
    if degree < relative_degree:
        return row, np.zeros((1, 1))
    return row, coefficients[-1] * (derivatives[-2] @ plant.b if degree else plant.d)


def _stack(
    plant: StateSpace,
    weighted: tuple[np.ndarray, np.ndarray],
    weights: tuple[StateSpace, ...],
    disturbance: float = 0.0,
) -> GeneralisedPlant:
    """Return M with weights on e, on the row `weighted` and, if there is a third, on u."""
    row, through = weighted[0], float(weighted[1][0, 0])
    direct = float(plant.d[0, 0])
    error = (-plant.c, (1.0, -disturbance * direct, -direct))
    signals = [error, (row, (0.0, disturbance * through, through))]
    if len(weights) == 3:
        signals.append((np.zeros_like(row), (0.0, 0.0, 1.0)))
    signals.append(error)
    inputs = [0, 1, 2] if disturbance else [0, 2]
    system = StateSpace(
        plant.a,
        np.hstack([np.zeros_like(plant.b), disturbance * plant.b, plant.b])[:, inputs],
        np.vstack([c for c, _ in signals]),
        np.array([d for _, d in signals])[:, inputs],
    )
    return GeneralisedPlant(series(system, _side_by_side(*weights, _UNIT)))


def _side_by_side(*systems: StateSpace) -> StateSpace:
    """Return the block-diagonal system."""
    return StateSpace(
        *(
            scipy.linalg.block_diag(*(getattr(system, name) for system in systems))
            for name in ('a', 'b', 'c', 'd')
        )
    )
