# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Observers of predictive controllers of many runs, the counterparts of the single ones."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.controllers.interface import Measured
from ddct_bringup.batch.stacks import by_run, distinct, product, stacked
from ddct_controllers.measurement import MOST
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.estimate.wear_observer import (
    ENGINE_SPEED,
    LEAST_TORQUE_N_M,
    MOST_TORQUE_N_M,
    TWIST,
    WearObserver,
)
from ddct_controllers.mpc.estimate.wear_state import (
    CLUTCH_ERROR,
    GAIN,
    HIGHEST_GAIN,
    LOWEST_GAIN,
    SIZE,
)
from ddct_controllers.mpc.model.transmission_model import DRIVELINE, MEASURED
from ddct_plant.base.errors import DdctError


class Observers:
    """The stack of `Observer`: all models have one order, and all start alike or at zero."""

    def __init__(self, observers: Sequence[Observer]) -> None:
        """Start with the next measurement."""
        first, places = distinct((id(each.model), id(each.gain), each.start) for each in observers)
        kinds = [observers[index] for index in first]
        self._correction = by_run([each.gain for each in kinds], places)
        self._prediction = by_run([np.hstack([e.model.a, e.model.b]) for e in kinds], places)
        self._started = kinds[0].start is None
        # States and twist are linear in the request and in the load.
        self._state = np.array([_at_rest(each) for each in kinds])[places]
        self._twist = kinds[0].model.states['twist']
        self._twist_per_torque = np.array([_twist_per_torque(each) for each in kinds])[places]
        self.wear_gain = np.ones(len(observers))
        """Estimated K_usura, without unit, (R,): that of a new clutch."""

    def correct(self, measured: Measured) -> np.ndarray:
        """Return x_(k|k), (R, n)."""
        speeds = measured_speeds(measured)
        if self._started:
            error = speeds - self._state[:, :MEASURED]
            self._state = self._state + product(self._correction, error)
        else:
            self._state[:, :MEASURED] = speeds
            self._state[:, self._twist] = measured.load_torque * self._twist_per_torque
            self._started = True
        return self._state

    def predict(self, *inputs: np.ndarray) -> None:
        """Advance by one period with the saturated request, C_m and C_load in N m, (R,) each."""
        self._state = product(self._prediction, np.column_stack([self._state, *inputs]))


def _at_rest(observer: Observer) -> np.ndarray:
    if observer.start is None:
        return np.zeros(len(observer.model.a))
    return observer.at_rest(observer.start, (0.0, 0.0, 0.0), 0.0)


def _twist_per_torque(observer: Observer) -> float:
    return 0.0 if observer.start is None else 1.0 / observer.start.halfshaft_stiffness


class WearObservers:
    """The stack of `WearObserver`: all models have one order."""

    def __init__(self, observers: Sequence[WearObserver]) -> None:
        """Start with the next measurement."""
        runs = len(observers)
        self._filter = stacked([each.filter for each in observers])
        self._started = False
        self._transition = self._filter.transition.copy()
        self._state = np.zeros((runs, SIZE))
        self._state[:, GAIN] = 1.0
        self._actuator = self._filter.actuator_at_rest
        self._covariance = self._filter.first_covariance

    @property
    def wear_gain(self) -> np.ndarray:
        """Estimates of K_usura, without unit, (R,)."""
        return self._state[:, GAIN]

    def correct(self, measured: Measured) -> np.ndarray:
        """Return x_(k|k) divided by K_usura, (R, n)."""
        speeds = measured_speeds(measured)
        if self._started:
            self._update(speeds)
        else:
            self._state[:, :MEASURED] = speeds
            self._state[:, TWIST] = measured.load_torque * self._filter.twist_per_torque
            self._started = True
        gain = self._state[:, GAIN, np.newaxis]
        driveline, errors = self._state[:, DRIVELINE] / gain, self._state[:, CLUTCH_ERROR:] / gain
        return np.hstack([driveline, self._actuator, errors])

    def predict(self, request: np.ndarray, *known: np.ndarray) -> None:
        """Advance by one period with the saturated request, C_m and C_load in N m, (R,) each."""
        own, transition, state = self._filter, self._transition, self._state
        request = np.minimum(request, MOST_TORQUE_N_M)[:, np.newaxis]
        effect = product(own.transmission, self._actuator) + own.at_once * request
        transition[:, DRIVELINE, GAIN] = effect
        at_bound = (state[:, GAIN] == LOWEST_GAIN) | (state[:, GAIN] == HIGHEST_GAIN)
        self._state = product(transition, state)
        self._state[:, DRIVELINE] += product(own.known, np.column_stack(known))
        self._covariance = _spread(transition, self._covariance) + own.process
        flows = effect[:, ENGINE_SPEED] / own.clutch_effect > LEAST_TORQUE_N_M
        self._covariance[:, GAIN, GAIN] += np.where(flows, own.gain_variance, 0.0)
        more = np.where(at_bound, own.clutch_variance, 0.0)
        self._covariance[:, CLUTCH_ERROR, CLUTCH_ERROR] += more
        self._actuator = product(own.actuator_a, self._actuator) + own.actuator_b * request

    def _update(self, speeds: np.ndarray) -> None:
        covariance, noise = self._covariance, self._filter.measurement_noise
        innovation = covariance[:, :MEASURED, :MEASURED] + noise
        try:
            gain = np.linalg.solve(innovation, covariance[:, :MEASURED]).transpose(0, 2, 1)
        except np.linalg.LinAlgError as error:
            raise DdctError(f'wear observer: a run of the batch has no gain ({error})') from error
        state = self._state + product(gain, speeds - self._state[:, :MEASURED])
        kept = np.zeros_like(covariance)
        kept[:] = np.eye(SIZE)
        kept[:, :, :MEASURED] -= gain
        self._covariance = _spread(kept, covariance) + _spread(gain, noise)
        self._state = _within_bounds(state, self._covariance)


def _within_bounds(state: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """Return the states (R, SIZE) of `within_bounds`."""
    gain = state[:, GAIN]
    bound = np.clip(gain, LOWEST_GAIN, HIGHEST_GAIN)
    beyond = np.flatnonzero(bound != gain)
    tied = covariance[beyond, :, GAIN] / covariance[beyond, GAIN, GAIN, np.newaxis]
    state[beyond] += tied * (bound - gain)[beyond, np.newaxis]
    state[:, GAIN] = bound
    return state


def _spread(maps: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """Return m p m' for each run."""
    return maps @ covariance @ maps.transpose(0, 2, 1)


def measured_speeds(measured: Measured) -> np.ndarray:
    """
    Return w_m, w_p, w_r in rad/s, (R, 3), NaN where the function of this name would raise.

    Such a run goes step by step, which gives it the reason.
    """
    speeds = np.column_stack([measured.engine_speed, measured.shaft_speed, measured.wheel_speed])
    others = [
        *(measured.engine_torque, measured.load_torque, measured.open_loop_torque),
        *(measured.slip_reference, measured.slip_reference_rate),
    ]
    usable = np.abs(np.column_stack([speeds, *others])).max(axis=1) <= MOST
    speeds[~usable] = np.nan
    return speeds
