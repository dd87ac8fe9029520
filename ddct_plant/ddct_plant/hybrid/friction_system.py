"""A linear system with dry-friction elements."""

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np

from ddct_plant.base.errors import ParameterError

SINGULAR = 1e-12
"""A principal minor of -h g counts as zero below this part of the product of its diagonal."""


@dataclass(frozen=True, eq=False)
class FrictionSystem:
    """
    dx/dt = a x + b u + g f, slips s = h x, |f_i| at most the capacity c_i of element i.

    While it slips f_i = sign(s_i) c_i. A set S that sticks has constant slips zero, so
    f_S = -(h_S g_S)^-1 h_S (a x + b u + g_F f_F). All principal minors of -h g must be positive:
    then each element opposes its slip, no stuck set is singular, and at every instant exactly one
    set of friction torques is consistent as long as static and kinetic capacity are the same.
    """

    a: np.ndarray
    """(n, n)."""
    b: np.ndarray
    """(n, m)."""
    g: np.ndarray
    """(n, N)."""
    h: np.ndarray
    """(N, n)."""

    def __post_init__(self) -> None:
        """Check shapes, values and minors; raise ParameterError otherwise."""
        for name in ('a', 'b', 'g', 'h'):
            matrix = np.array(getattr(self, name), dtype=float)
            if matrix.ndim != 2 or not np.all(np.isfinite(matrix)):
                raise ParameterError(f'friction system: {name} must be a matrix of finite numbers')
            matrix.setflags(write=False)
            object.__setattr__(self, name, matrix)
        states, elements = self.g.shape
        shapes = {'a': (states, states), 'b': (states, self.b.shape[1]), 'h': (elements, states)}
        for name, shape in shapes.items():
            if getattr(self, name).shape != shape:
                raise ParameterError(
                    f'friction system: {name} is {getattr(self, name).shape}, it must be {shape}'
                )
        self._require_positive_minors()

    @property
    def elements(self) -> int:
        """N, the number of friction elements."""
        return len(self.h)

    @cached_property
    def slip_sizes(self) -> np.ndarray:
        """(N, n): times |x| how large the sums are whose rounding the slips have."""
        return np.abs(self.h)

    def _require_positive_minors(self) -> None:
        mobility = -self.h @ self.g
        for i, own in enumerate(np.diag(mobility)):
            if own <= 0.0:
                raise ParameterError(
                    f'friction system: h g of element {i} is {0.0 - own:g}, it must be negative: '
                    'friction opposes the slip it acts on'
                )
        for size in range(2, self.elements + 1):
            for stuck in combinations(range(self.elements), size):
                block = mobility[np.ix_(stuck, stuck)]
                if np.linalg.det(block) <= SINGULAR * np.prod(np.diag(block)):
                    raise ParameterError(
                        f'friction system: h g of the elements {stuck} is singular: they cannot '
                        'stick together, as their slips or torques depend on each other'
                    )
