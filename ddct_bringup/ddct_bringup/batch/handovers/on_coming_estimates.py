# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The Kalman filters of many shifts at once, for what their on-coming clutches carry."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.stacks import stacked
from ddct_controllers.handover.on_coming_estimate import (
    CARRIES_FROM_N_M,
    DELAY,
    DELAY_SPREAD_S,
    FIRST_GAIN,
    FIRST_LOAD_N_M,
    FIRST_OFFSET_N_M,
    FIRST_TWIST_RAD,
    GAIN,
    LEAST_GAIN,
    MOST_GAIN,
    OFFSET,
    OnComingModel,
)
from ddct_plant.base.timebase import PERIOD_S

_FIRST = FIRST_TWIST_RAD, FIRST_LOAD_N_M, FIRST_GAIN, FIRST_OFFSET_N_M, DELAY_SPREAD_S


class OnComingEstimates:
    """The counterpart of `OnComingEstimate` for R shifts; every value is (R,)."""

    def __init__(self, models: Sequence[OnComingModel]) -> None:
        """Take the model of each shift."""
        self._model: Any = stacked(models)
        self._torque = self._load = np.zeros(len(models))
        self._states = np.zeros((len(models), 7))
        self._spread = np.zeros((len(models), 7, 7))
        # One transposed copy: a view of another layout gives another rounding in a product.
        self._transposed = np.ascontiguousarray(self._model.measured.swapaxes(1, 2))

    @property
    def wear_gain(self) -> np.ndarray:
        """Estimates of the wear gain, within the bounds for requests."""
        return np.clip(self._states[:, GAIN], LEAST_GAIN, MOST_GAIN)

    @property
    def offset(self) -> np.ndarray:
        """Estimates of the offset in N m."""
        offset: np.ndarray = self._states[:, OFFSET]
        return offset

    def start(
        self,
        rows: np.ndarray,
        engine_speed: np.ndarray,
        wheel_speed: np.ndarray,
        engine_torque: np.ndarray,
    ) -> None:
        """Take the first w_m and wheel speed in rad/s, and C_m in N m, in rows (R,) of bool."""
        model, none = self._model, np.zeros(len(rows))
        twist = model.gear.wheel_torque(engine_torque) / model.stiffness
        first = model.gear.wheel_speed(engine_speed), wheel_speed, twist, none, none + 1.0, none
        states = np.stack([*first, model.delay_s], axis=-1)
        self._states = np.where(rows[:, None], states, self._states)
        diagonal = np.zeros((len(rows), 7))
        diagonal[:, :2] = np.diagonal(model.noise, axis1=1, axis2=2)
        diagonal[:, 2:] = np.square(_FIRST)
        self._spread = np.where(
            rows[:, None, None], diagonal[:, :, None] * np.eye(7), self._spread
        )

    def predict(
        self, engine_torque: np.ndarray, load_torque: np.ndarray, torque: np.ndarray
    ) -> None:
        """Take C_m and C_load of a period, and the mean torque of the actuators, all in N m."""
        model = self._model
        step = np.zeros_like(self._spread)
        step[:] = np.eye(7)
        step[:, :4, :4] = model.step
        by_torque = model.held[:, :, 1]
        step[:, :4, GAIN] = by_torque * torque[:, None]
        step[:, :4, OFFSET] = np.where(torque[:, None] > CARRIES_FROM_N_M, by_torque, 0.0)
        step[:, :4, DELAY] = by_torque * (self._torque - torque)[:, None] / PERIOD_S
        self._torque, self._load = torque, load_torque
        states = _of_each(step, self._states)
        held = model.held[:, :, 0] * engine_torque[:, None]
        states[:, :4] += held + model.held[:, :, 2] * load_torque[:, None]
        self._states = states
        self._spread = step @ self._spread @ step.swapaxes(1, 2) + model.drift

    def correct(self, rows: np.ndarray, engine_speed: np.ndarray, wheel_speed: np.ndarray) -> None:
        """Take w_m and the wheel speed in rad/s in rows (R,) whose off-going clutch is locked."""
        model, spread = self._model, self._spread
        measured = np.stack([model.gear.wheel_speed(engine_speed), wheel_speed], axis=-1)
        error = measured - _of_each(model.measured, self._states)
        error[:, 1] -= model.measured_load * self._load
        by_states = model.measured @ spread
        innovation = by_states @ self._transposed + model.noise
        share = np.linalg.solve(innovation, by_states).swapaxes(1, 2)
        states = self._states + _of_each(share, error)
        spread = spread - share @ by_states
        spread = 0.5 * (spread + spread.swapaxes(1, 2))
        self._states = np.where(rows[:, None], states, self._states)
        self._spread = np.where(rows[:, None, None], spread, self._spread)


def _of_each(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Return the product (R, m) of each matrix (R, m, n) with its vector (R, n)."""
    products: np.ndarray = np.matmul(matrices, vectors[:, :, None])[:, :, 0]
    return products
