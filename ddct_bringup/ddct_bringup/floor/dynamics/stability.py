# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Stability of the driveline with torques that depend on speeds and are held over a period."""

import numpy as np

from ddct_bringup.floor.dynamics import propagators
from ddct_bringup.floor.dynamics.laws import Law
from ddct_bringup.floor.dynamics.propagators import ENGINE, WHEEL
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.parameters import DrivelineParameters

_C_M, _C_LOAD = 4, 5
"""Columns of C_m and C_load in the map of a period."""
_GROWTH = 1.5
"""Factor by which a state may grow in a period; the full load of an engine makes it 1.04."""


def require_stable(name: str, parameters: DrivelineParameters, load: Law, engine: Law) -> None:
    """
    Raise ParameterError where the state of a scenario `name` grows fast from period to period.

    That is so where a torque that resists a speed is held for too long, as a drag beyond that of
    any car. A run then grows beyond all numbers, whatever the requests are.
    """
    slopes = (load.slope, engine.slope)
    if all(np.isfinite(each).all() for each in slopes):
        steepest = load.slope[np.argmax(np.abs(load.slope))]
        growth = max(
            _growth(matrix, engine.slope.min(), steepest)
            for matrix in (propagators.slipping(parameters), propagators.locked(parameters))
        )
    else:
        growth = np.inf
    if growth > _GROWTH:
        raise ParameterError(
            f'scenario {name}: the model is unstable: its state grows {growth:.3g} times in '
            '10 ms: there is no floor: give a driveline and a load of a car'
        )


def _growth(matrix: np.ndarray, engine_slope: float, load_slope: float) -> float:
    """Return the spectral radius of the map of a period with torques that depend on speeds."""
    transition = matrix[:, :4].copy()
    transition[:, ENGINE] += engine_slope * matrix[:, _C_M]
    transition[:, WHEEL] += load_slope * matrix[:, _C_LOAD]
    return float(np.abs(np.linalg.eigvals(transition)).max())
