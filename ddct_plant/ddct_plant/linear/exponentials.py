# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Matrix exponentials of many matrices at once."""

import numpy as np

_DEGREE = 13
"""Degree of the Taylor polynomial: 0.5^14 / 14! is below the rounding of 1."""


def exponentials(matrices: np.ndarray) -> np.ndarray:
    """
    Return exp(A) of each matrix of a stack, (..., n, n), independent of the other matrices.

    scipy's goes through a stack matrix by matrix, which for small ones takes four times as long.
    exp(A) = exp(A / 2^s)^(2^s), with s so that ||A^4||^(1/4) and ||A^5||^(1/5) are at most 2^s /
    2. The norm of A itself may be far above both, where states have different units; it would need
    so many squarings that their rounding counts (Al-Mohy and Higham, SIAM J. Matrix Anal. Appl.
    31(3), 2009). A matrix that is not finite gives a result that is not finite.
    """
    fourth = np.linalg.matrix_power(matrices, 4)
    size = np.maximum(_norm(fourth) ** 0.25, _norm(fourth @ matrices) ** 0.2)
    squarings = np.maximum(np.frexp(size)[1] + 1, 0)[..., np.newaxis, np.newaxis]
    scaled = np.ldexp(matrices, -squarings)
    one = np.eye(matrices.shape[-1])
    power = one
    for degree in range(_DEGREE, 0, -1):
        power = one + scaled @ power / degree
    for squaring in range(np.max(squarings, initial=0)):
        power = np.where(squaring < squarings, power @ power, power)
    return power


def _norm(matrices: np.ndarray) -> np.ndarray:
    """Return the 1-norm of each matrix, (...)."""
    return np.max(np.sum(np.abs(matrices), axis=-2), axis=-1)
