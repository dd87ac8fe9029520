# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Sensors of many runs."""

import math
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Any, NamedTuple

import numpy as np

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.sensors.parameters import SensorOptions, SpeedSensor
from ddct_plant.sensors.sensor import gaussian, losses

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
        seeds = [run.case.seed for run in runs]
        options: dict[str, list[Any]] = {
            name: [getattr(run.scenario.sensors, name) for run in runs] for name in _QUANTITIES
        }
        self._sensors = {name: _Sensor(each, name, seeds, steps) for name, each in options.items()}
        self._teeth = {name: _Teeth(options[name]) for name in _JOINTS}

    def speeds(self, step: int, true: DrivelineOutputs) -> SensedSpeeds:
        """Return the measured speeds at step k; steps follow one another."""
        angles, speeds = true.joint_position, true.joint_speed
        sensed: dict[str, np.ndarray] = {}
        for name, joint in _JOINTS.items():
            angle: Any = getattr(angles, joint)
            speed: Any = getattr(speeds, joint)
            speed = self._teeth[name].take(step, angle, speed)
            sensed[name] = self._sensors[name].take(step, speed)
        vehicle: Any = true.vehicle_speed
        vehicle = self._sensors['vehicle_speed'].take(step, vehicle)
        return SensedSpeeds(**sensed, vehicle_speed=vehicle)

    def torque(self, step: int, engine_torque: np.ndarray) -> np.ndarray:
        """Return the estimates of C_m in N m over the coming period, (R,)."""
        return self._sensors['engine_torque'].take(step, engine_torque)

    @property
    def unsure(self) -> np.ndarray:
        """Runs with a reading that rounding may have changed by a whole step, (R,)."""
        parts: list[_Sensor | _Teeth] = [*self._sensors.values(), *self._teeth.values()]
        unsure: np.ndarray = np.any([part.unsure for part in parts], axis=0)
        return unsure


_JOINTS = {'engine_speed': 'engine', 'shaft_speed': 'primary_shaft', 'wheel_speed': 'wheel'}
"""Joint of each sensor of a shaft's speed."""
_QUANTITIES = (*_JOINTS, 'vehicle_speed', 'engine_torque')


class _Sensor:
    """Sensors of one quantity of R runs, the counterpart of `Sensor`."""

    def __init__(
        self, options: Sequence[SensorOptions], quantity: str, seeds: Sequence[int], steps: int
    ) -> None:
        self._gain = np.array([each.gain for each in options])
        noise, self._quantum, self._bias = np.array([each.errors for each in options]).T
        self._noise = _drawn(
            [
                gaussian(seed, quantity) if sigma else None
                for seed, sigma in zip(seeds, noise, strict=True)
            ],
            steps,
        )
        if self._noise is not None:
            self._noise *= noise
        self._lost = _drawn(
            [
                losses(seed, quantity, each) if each.dropout else None
                for seed, each in zip(seeds, options, strict=True)
            ],
            steps,
        )
        self._delay = np.array([each.delay_steps for each in options])
        self._readings = np.empty((steps + 1, len(options)))
        self._columns = np.arange(len(options))
        self._value = np.full(len(options), math.nan)
        self.unsure = np.zeros(len(options), dtype=bool)
        """Runs with a reading that rounding may have changed by a quantum, (R,)."""

    def take(self, step: int, truth: np.ndarray) -> np.ndarray:
        """Return the measurements of `truth` at step k, (R,)."""
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
        if not self._quantum.any():
            return value
        quantised = (self._quantum > 0.0) & np.isfinite(value)
        quantum = np.where(quantised, self._quantum, 1.0)
        # The remainder is exact, as that of `math.remainder`.
        rest = np.fmod(value, quantum)
        beyond = quantum - np.abs(rest)
        edge = np.abs(np.abs(rest) - beyond)
        self.unsure |= quantised & (edge <= CLOSE * np.abs(value))
        rest = np.where(np.abs(rest) > beyond, rest - np.copysign(quantum, rest), rest)
        return np.where(quantised, value - rest, value)


def _drawn(streams: Sequence[Iterator[float] | None], steps: int) -> np.ndarray | None:
    """Return the first values of each stream, (N + 1, R), zero without one; None without any."""
    if not any(streams):
        return None
    count = steps + 1
    rows = [[0.0] * count if each is None else list(islice(each, count)) for each in streams]
    return np.array(rows, dtype=float).T.copy()


class _Teeth:
    """Encoder wheels of R shafts, the counterpart of `ToothCount` where there are teeth."""

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
        """Runs with a count that rounding may have changed by a tooth, (R,)."""

    def take(self, step: int, position: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Return the counted speeds in rad/s at step k, true ones without teeth, (R,)."""
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
