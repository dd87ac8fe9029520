# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Torques that act on the driveline in each period, as affine functions of the variables."""

import numpy as np

from ddct_bringup.floor.dynamics.capacity import CapacityRange
from ddct_bringup.floor.dynamics.columns import Columns
from ddct_bringup.floor.dynamics.engine_laws import EngineLaw
from ddct_bringup.floor.dynamics.laws import Law
from ddct_bringup.floor.dynamics.propagators import ENGINE, NODES, WHEEL
from ddct_bringup.floor.dynamics.shapes import shape_effects
from ddct_bringup.floor.dynamics.start import ActuatorModel, Start
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import RunSettings


class Inputs:
    """C_m, C_load and capacity, period by period: idle control and G_a depend on those before."""

    def __init__(
        self,
        settings: RunSettings,
        start: Start,
        engine: EngineLaw,
        load: Law,
        capacity: CapacityRange,
        columns: Columns,
    ) -> None:
        """Begin at control start."""
        self._wear_gain, self._start = settings.case.wear_gain, start
        self._engine, self._load, self._capacity = engine, load, capacity
        self._columns = columns
        self._model = ActuatorModel.of(settings)
        self._actuator = np.zeros((len(start.actuator), columns.count))
        self._actuator[:, 0] = start.actuator
        self._integral = np.zeros(columns.count)
        self._shapes = shape_effects(gears_of(settings.scenario)) if settings.shift else None

    def engine(self, k: int, state: np.ndarray) -> np.ndarray:
        """Return C_m over period k in N m, (columns,), for the state (4, columns) at its start."""
        speed = state[ENGINE]
        torque = _torque(self._engine, self._columns.engine, k, speed)
        integral = self._engine.integral
        if integral:
            torque += integral.share[k] * self._integral
            self._integral = integral.keep[k] * self._integral + integral.gain[k] * speed
        return torque

    def load(self, k: int, state: np.ndarray) -> np.ndarray:
        """Return C_load over period k in N m, (columns,), for the state (4, columns)."""
        return _torque(self._load, self._columns.load, k, state[WHEEL])

    def clutch(self, k: int) -> np.ndarray:
        """Return the capacity at the nodes of period k in N m, (11, columns)."""
        columns = self._columns
        in_effect = np.zeros((len(self._model.delays), columns.count))
        for row, delay in zip(in_effect, self._model.delays, strict=True):
            if k < delay:
                row[0] = self._start.request(self._start.step + k - delay)
            else:
                row[1 + k - delay] = 1.0
        values = np.vstack([self._actuator, in_effect])
        self._actuator = self._model.state_update @ values
        nodes = self._wear_gain * (self._model.nodes @ values)
        if columns.capacity.stop > columns.capacity.start:
            nodes[:, columns.capacity.start + k] += 1.0
        else:
            nodes[:, 0] += self._capacity.low
        if k in columns.clipped:
            nodes[:, columns.of_nodes(k)] += np.eye(NODES)
        return np.asarray(nodes)

    def add_off_going(self, k: int, state: np.ndarray) -> None:
        """Add what the off-going clutch of a shift does in period k to the state at its end."""
        off_going = self._start.off_going
        if off_going is None or k >= off_going.periods:
            return
        if k < off_going.known:
            state[:, 0] += off_going.effects[k]
        else:
            state[:, self._columns.of_shapes(k - off_going.known)] += self._shapes


def _torque(law: Law, columns: slice, k: int, speed: np.ndarray) -> np.ndarray:
    """Return the torque of a law over period k in N m, (columns,)."""
    torque = law.slope[k] * speed
    torque[0] += law.offset[k]
    if columns.stop > columns.start:
        torque[columns.start + k] += 1.0
    return np.asarray(torque)
