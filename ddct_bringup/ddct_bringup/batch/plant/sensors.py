# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Sensors of many runs."""

import math
from collections.abc import Iterable, Sequence
from itertools import islice
from typing import Any, NamedTuple

import numpy as np

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.sensors.parameters import SensorOptions, SpeedSensor
from ddct_plant.sensors.sensor import gaussians, losses

CLOSE = 1e-9
"""
Distance from the edge of a step, over the size of the value, within which a reading is not sure.

Rounding may put it on the other side, a whole quantum or tooth away.
"""


class SensedSpeeds(NamedTuple):
    """Measured speeds of R runs at one step, (R,) each, as `MeasuredSpeeds` has them."""

    engine_speed: np.ndarray
    shaft_speed: np.ndarray
    wheel_speed: np.ndarray
    vehicle_speed: np.ndarray

    @property
    def slip_speed(self) -> np.ndarray:
        """Slip speed w_d in rad/s: measured w_m less measured w_p."""
        return self.engine_speed - self.shaft_speed


class StackedSensors:
    """The sensors of R runs, the counterpart of `DrivelineSensors` and `TorqueEstimate`."""

    def __init__(self, runs: Sequence[RunSettings], steps: int) -> None:
        """Make the sensors for steps 0 to N; their random numbers follow from the seeds."""
        self._speeds = _Sensors(runs, _SPEEDS, steps)
        self._torques = _Sensors(runs, ('engine_torque',), steps)
        self._teeth = _Teeth(_options(runs, _JOINTS))
        self._runs = len(runs)

    def speeds(self, step: int, true: DrivelineOutputs) -> SensedSpeeds:
        """Return the measured speeds at step k; steps follow one another."""
        angles, speeds = (
            np.concatenate([getattr(each, joint) for joint in _JOINTS.values()])
            for each in (true.joint_position, true.joint_speed)
        )
        counted = self._teeth.take(step, angles, speeds)
        vehicle: Any = true.vehicle_speed
        taken = self._speeds.take(step, np.concatenate([counted, vehicle]))
        return SensedSpeeds(*taken.reshape(len(_SPEEDS), self._runs))

    def torque(self, step: int, engine_torque: np.ndarray) -> np.ndarray:
        """Return the estimates of C_m in N m over the coming period, (R,)."""
        return self._torques.take(step, engine_torque)

    @property
    def unsure(self) -> np.ndarray:
        """Runs with a reading that rounding may have changed by a whole step, (R,)."""
        parts = (self._speeds.unsure, self._torques.unsure, self._teeth.unsure)
        of_runs = np.concatenate(parts).reshape(-1, self._runs)
        unsure: np.ndarray = np.any(of_runs, axis=0)
        return unsure


_JOINTS = {'engine_speed': 'engine', 'shaft_speed': 'primary_shaft', 'wheel_speed': 'wheel'}
"""Joint of each sensor of a shaft's speed."""
_SPEEDS = (*_JOINTS, 'vehicle_speed')


def _options(runs: Sequence[RunSettings], quantities: Iterable[str]) -> list[Any]:
    """Return the options of the sensors of all runs, quantity by quantity."""
    return [getattr(run.scenario.sensors, name) for name in quantities for run in runs]


class _Sensors:
    """Sensors of Q quantities of R runs, quantity by quantity, the counterpart of `Sensor`."""

    def __init__(self, runs: Sequence[RunSettings], quantities: Sequence[str], steps: int) -> None:
        options: Sequence[SensorOptions] = _options(runs, quantities)
        streams = [(run.case.seed, quantity) for quantity in quantities for run in runs]
        self._gain = np.array([each.gain for each in options])
        noise, quantum, self._bias = np.array([each.errors for each in options]).T
        self._quantised = quantum > 0.0 if (quantum > 0.0).any() else None
        self._quantum = np.where(quantum > 0.0, quantum, 1.0)
        counts = [min(run.scenario.steps, steps) + 1 for _ in quantities for run in runs]
        self._noise = _stacked_columns(
            [
                gaussians(*stream, count) if sigma else None
                for stream, sigma, count in zip(streams, noise, counts, strict=True)
            ],
            steps,
        )
        if self._noise is not None:
            self._noise *= noise
        self._lost = _stacked_columns(
            [
                list(islice(losses(*stream, each), count)) if each.dropout else None
                for stream, each, count in zip(streams, options, counts, strict=True)
            ],
            steps,
        )
        self._delay = np.array([each.delay_steps for each in options])
        self._readings = np.empty((steps + 1, len(options)))
        self._columns = np.arange(len(options))
        self._value = np.full(len(options), math.nan)
        self.unsure = np.zeros(len(options), dtype=bool)
        """Sensors with a reading that rounding may have changed by a quantum, (Q R,)."""

    def take(self, step: int, truth: np.ndarray) -> np.ndarray:
        """Return the measurements of `truth` at step k, (Q R,)."""
        self._readings[step] = self._reading(step, truth)
        value = self._readings[np.maximum(step - self._delay, 0), self._columns]
        if self._lost is not None:
            value = np.where(self._lost[step], self._value, value)
        self._value = value
        return value

    def _reading(self, step: int, truth: np.ndarray) -> np.ndarray:
        value = self._gain * truth + self._bias
        if self._noise is not None:
            value = value + self._noise[step]
        if self._quantised is None:
            return value
        quantised, quantum = self._quantised & np.isfinite(value), self._quantum
        # The remainder is exact, as that of `math.remainder`.
        rest = np.fmod(value, quantum)
        beyond = quantum - np.abs(rest)
        edge = np.abs(np.abs(rest) - beyond)
        self.unsure |= quantised & (edge <= CLOSE * np.abs(value))
        rest = np.where(np.abs(rest) > beyond, rest - np.copysign(quantum, rest), rest)
        return np.where(quantised, value - rest, value)


def _stacked_columns(columns: Sequence[Sequence[Any] | np.ndarray | None], steps: int) -> Any:
    """Return random values of all runs as columns, (N + 1, R), zero where a run has none."""
    if all(each is None for each in columns):
        return None
    values = np.zeros((steps + 1, len(columns)))
    for place, each in enumerate(columns):
        if each is not None:
            values[: len(each), place] = each
    return values


class _Teeth:
    """Encoder wheels of shafts, (Q R,), the counterpart of `ToothCount` where there are teeth."""

    def __init__(self, options: Sequence[SpeedSensor]) -> None:
        teeth = np.array([each.teeth for each in options])
        self._counted = teeth > 0
        self._any = bool(self._counted.any())
        periods = np.array([each.count_steps for each in options])
        self._teeth_per_rad = teeth / (2.0 * math.pi)
        turn = np.where(self._counted, teeth, 1) * periods * PERIOD_S
        self._speed_per_tooth = 2.0 * math.pi / turn
        self._periods, self._kept = periods, int(periods.max()) + 1
        self._counts = np.zeros((self._kept, len(options)))
        """Counts of the last periods, in a ring."""
        self._columns = np.arange(len(options))
        self.unsure = np.zeros(len(options), dtype=bool)
        """Shafts with a count that rounding may have changed by a tooth, (Q R,)."""

    def take(self, step: int, position: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Return the counted speeds in rad/s at step k, true ones without teeth, (Q R,)."""
        if not self._any:
            return speed
        if step == 0:
            for back in range(1, self._kept):
                earlier = position - back * PERIOD_S * speed
                self._counts[-back] = np.floor(earlier * self._teeth_per_rad)
        passed = position * self._teeth_per_rad
        edge = np.abs(passed - np.round(passed))
        self.unsure |= self._counted & (edge <= CLOSE * np.abs(passed)) & (passed != 0.0)
        self._counts[step % self._kept] = np.floor(passed)
        before = self._counts[(step - self._periods) % self._kept, self._columns]
        counted = (self._counts[step % self._kept] - before) * self._speed_per_tooth
        # As in `ShaftSensor`, a position that is not finite has no count.
        return np.where(self._counted & np.isfinite(position), counted, speed)
