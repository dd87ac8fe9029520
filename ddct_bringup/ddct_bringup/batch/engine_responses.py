# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Responses of many engines to requests within their authority."""

from collections.abc import Sequence

import numpy as np

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import EngineAuthority


class EngineResponses:
    """Responses of R engines, the counterpart of `EngineResponse`."""

    def __init__(self, authorities: Sequence[EngineAuthority]) -> None:
        """Start at the demands."""
        self._most = np.array([each.deviation_n_m for each in authorities])
        self._most_change = np.array([each.slew_n_m_s * PERIOD_S for each in authorities])
        self._lag_share = np.array([each.lag_share for each in authorities])
        self._least_torque = np.array([each.minimum_torque_n_m for each in authorities])
        self._most_torque = np.array([each.maximum_torque_n_m for each in authorities])
        self._requested = self._deviation = np.zeros(len(authorities))

    def deliver(self, demand: np.ndarray, request: np.ndarray) -> np.ndarray:
        """Return C_m over the coming period for demands and requests, all in N m, (R,)."""
        requested = _limited(request - demand, self._most)
        change = _limited(requested - self._requested, self._most_change)
        self._requested = self._requested + change
        missing = self._requested - self._deviation
        self._deviation = self._deviation + self._lag_share * missing
        torque = demand + self._deviation
        return np.minimum(np.maximum(torque, self._least_torque), self._most_torque)


def _limited(values: np.ndarray, limits: np.ndarray) -> np.ndarray:
    return np.minimum(np.maximum(values, -limits), limits)
