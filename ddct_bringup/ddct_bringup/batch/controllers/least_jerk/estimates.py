# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Estimates of `least_jerk` of many runs: demand, carried torque, slip."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.controllers.least_jerk.values import Values, numbers
from ddct_controllers.least_jerk.demand_trend import (
    AFTER_DRIFT,
    AFTER_STEP,
    EXPLAINED_MEAN_N_M,
    EXPLAINED_N_M,
    LONGEST,
    MEAN_SHARE,
)
from ddct_controllers.least_jerk.design import LeastJerkDesign
from ddct_controllers.least_jerk.slip_estimate import TORQUE_RATE_SHARE
from ddct_controllers.least_jerk.torque_covariance import TorqueCovariance, TorqueNoise
from ddct_controllers.least_jerk.torque_estimate import HIGHEST_GAIN, LOWEST_GAIN
from ddct_plant.base.timebase import PERIOD_S


class DemandTrends(Values):
    """The counterpart of `DemandTrend`."""

    def __init__(self, runs: int) -> None:
        """Start with the next measurement."""
        self.level, self.rate, self._mean = np.zeros((3, runs))
        self._count = np.zeros(runs)

    def update(self, engine_torque: np.ndarray) -> None:
        """Take the C_m of a period in N m."""
        if not self._count.any():
            self.level, self._count = engine_torque, np.ones(len(engine_torque))
            return
        predicted = self.level + PERIOD_S * self.rate
        error = engine_torque - predicted
        self._mean = self._mean + MEAN_SHARE * (error - self._mean)
        count = np.minimum(self._count + 1.0, LONGEST)
        steps = np.abs(error) > EXPLAINED_N_M
        drifts = ~steps & (np.abs(self._mean) > EXPLAINED_MEAN_N_M)
        most = np.where(steps, AFTER_STEP, np.where(drifts, AFTER_DRIFT, LONGEST))
        count = self._count = np.minimum(count, most)
        both = count * (count + 1.0)
        self.level = predicted + 2.0 * (2.0 * count - 1.0) / both * error
        self.rate = self.rate + 6.0 / both / PERIOD_S * error


class CarriedTorques(Values):
    """The counterpart of `CarriedTorque`."""

    def __init__(self, designs: Sequence[LeastJerkDesign]) -> None:
        """Start with a new clutch, of which nothing is measured."""
        drivelines = [each.driveline for each in designs]
        options = [each.options for each in designs]
        self._share = numbers(designs, 'applied_share')
        self._step = PERIOD_S / numbers(drivelines, 'engine_inertia')
        self._damping = numbers(drivelines, 'engine_damping')
        self._noise = TorqueNoise(
            numbers(options, 'gain_drift'), numbers(options, 'offset_drift_n_m')
        )
        runs = len(designs)
        self.gain, self._applied_gain = np.ones((2, runs))
        self.offset, self._applied_offset, self._speed = np.zeros((3, runs))
        self._covariance = TorqueCovariance()

    def carried(self, torque: np.ndarray) -> np.ndarray:
        """Return the torques in N m that the clutches carry for torques of the actuators."""
        return self.gain * torque + self.offset

    def request(self, torque: np.ndarray) -> np.ndarray:
        """Return the requests in N m, not negative, for torques in N m to be carried."""
        return np.maximum((torque - self._applied_offset) / self._applied_gain, 0.0)

    def applied(self, request: np.ndarray) -> np.ndarray:
        """Return the torques in N m that requests in N m are made for."""
        return self._applied_gain * request + self._applied_offset

    def follow(self, which: np.ndarray, speed: np.ndarray) -> None:
        """Take measured w_m in rad/s after a period that says nothing about these clutches."""
        self.put(which, _speed=speed)
        self._put_covariance(which, self._covariance.at_measured_speed())

    def update(
        self, which: np.ndarray, speed: np.ndarray, engine_torque: np.ndarray, torque: np.ndarray
    ) -> None:
        """Take w_m in rad/s after a period in which these clutches slipped; torques in N m."""
        driven = engine_torque - self._damping * self._speed - self.carried(torque)
        predicted = self._speed + self._step * driven
        gains, covariance = self._covariance.after_period(self._step, torque, self._noise)
        error = speed - predicted
        gain = np.clip(self.gain + gains.gain * error, LOWEST_GAIN, HIGHEST_GAIN)
        offset = self.offset + gains.offset * error
        self.put(
            which,
            gain=gain,
            offset=offset,
            _applied_gain=self._applied_gain + self._share * (gain - self._applied_gain),
            _applied_offset=self._applied_offset + self._share * (offset - self._applied_offset),
            _speed=predicted + gains.speed * error,
        )
        self._put_covariance(which, covariance)

    def _put_covariance(self, which: np.ndarray, covariance: TorqueCovariance) -> None:
        pairs = zip(covariance, self._covariance, strict=True)
        self._covariance = TorqueCovariance(*(np.where(which, *pair) for pair in pairs))


class RigidSlips(Values):
    """The counterpart of `RigidSlip`."""

    def __init__(self, designs: Sequence[LeastJerkDesign]) -> None:
        """Start with the next measurement."""
        single = [each.slip() for each in designs]
        self.inertia, self._twist_s2, self._slip_share, self._surplus_share = (
            numbers(single, name)
            for name in ('inertia', 'twist_s2', 'slip_share', 'surplus_share')
        )
        self.slip, self.surplus_error, self._torque_rate = np.zeros((3, len(designs)))

    def follow(self, which: np.ndarray, measured: np.ndarray, keep: np.ndarray) -> None:
        """Take the measured slips in rad/s; the error of the surplus stays where `keep` is."""
        self.put(which, slip=measured, _torque_rate=0.0)
        self.put(which & ~keep, surplus_error=0.0)

    def update(
        self, which: np.ndarray, measured: np.ndarray, surplus: np.ndarray, change: np.ndarray
    ) -> None:
        """Take the measured slips in rad/s after a period of slipping; torques in N m."""
        torque_rate = self._torque_rate
        torque_rate = torque_rate + TORQUE_RATE_SHARE * (change / PERIOD_S - torque_rate)
        predicted = self.slip - PERIOD_S / self.inertia * (surplus + self.surplus_error)
        error = measured + self._twist_s2 * torque_rate - predicted
        self.put(
            which,
            slip=predicted + self._slip_share * error,
            surplus_error=self.surplus_error - self._surplus_share * error,
            _torque_rate=torque_rate,
        )

    def update_held_shaft(self, which: np.ndarray, measured: np.ndarray, rate: np.ndarray) -> None:
        """Take the measured slips in rad/s while these cars stand; `rate` is that of w_m."""
        predicted = self.slip + PERIOD_S * rate
        slip = predicted + self._slip_share * (measured - predicted)
        self.put(which, slip=slip, surplus_error=0.0)
