# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engines of many runs: the driver's demand, within the limits of the engines."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.engine_responses import EngineResponses
from ddct_bringup.batch.limited_engines import LimitedEngines
from ddct_bringup.batch.stacks import distinct
from ddct_plant.base.timebase import STEPS_PER_S
from ddct_plant.scenario.scenario import Scenario


class Engines:
    """
    Engines of R runs, the counterpart of `Engine`.

    Either all of them have limits or none has.
    """

    def __init__(self, scenarios: Sequence[Scenario], steps: int) -> None:
        """Extend the demands to step `steps`."""
        times = np.arange(steps + 1) / STEPS_PER_S
        demands = [scenario.demand for scenario in scenarios]
        first, places = distinct(demands)
        profiles = [demands[index].over(times) for index in first]
        self._demands = np.stack([profiles[place] for place in places], axis=-1)
        self._responses = EngineResponses([each.engine_authority for each in scenarios])
        limits = [each.engine_limits for each in scenarios if each.engine_limits is not None]
        self._limited = LimitedEngines(limits) if limits else None

    def demand(self, step: int) -> np.ndarray:
        """Return the driver's demands of C_m in N m, (R,), at step `step`."""
        demand: np.ndarray = self._demands[step]
        return demand

    def torque(
        self, demand: np.ndarray, request: np.ndarray | None, speed: np.ndarray
    ) -> np.ndarray:
        """Return C_m over a period for demands and requests in N m at w_m in rad/s, (R,) each."""
        requested = demand if request is None else self._responses.deliver(demand, request)
        return requested if self._limited is None else self._limited.deliver(requested, speed)

    def over(self, speed: np.ndarray) -> np.ndarray:
        """Return for w_m in rad/s, (R,), whether the engine ends the run."""
        if self._limited is None:
            return np.zeros(len(speed), dtype=bool)
        return self._limited.over(speed)
