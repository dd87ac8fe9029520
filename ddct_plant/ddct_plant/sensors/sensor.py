# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Model of one sensor, sampled once per step.

Its random numbers are streams that depend on the seed of the run and the quantity alone.
"""

import math
import zlib
from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.sensors.parameters import SensorOptions, SpeedSensor

_BLOCK = 256
"""Random numbers drawn at a time; the size of the block does not change the numbers."""


class Sample(NamedTuple):
    """Measurement of a sensor at one step."""

    value: float
    """Measured value, in the unit of the quantity."""
    held: bool
    """Whether the sample of this step is lost, so that the value is the last received one."""


class Sensor:
    """
    y_k = s_(k-d), or y_(k-1) where sample k is lost; s_k = Q(gain x_k + bias + sigma n_k).

    x_k is true at step k, n_k standard normal, Q rounds to the nearest multiple of the quantum, d
    is the delay in periods, and s_k is s_0 before t_0.
    """

    def __init__(self, options: SensorOptions, quantity: str, seed: int) -> None:
        """Make the sensor; its random numbers follow from seed and name of the quantity."""
        self._gain = options.gain
        self._noise, self._quantum, self._bias = options.errors
        self._normal = gaussian(seed, quantity) if self._noise else None
        self._losses = losses(seed, quantity, options) if options.dropout else None
        self._places = 1 + options.delay_steps
        self._line: deque[float] = deque(maxlen=self._places)
        self._sample = Sample(math.nan, held=False)

    def take(self, truth: float) -> Sample:
        """Return the measurement of `truth`, in the unit of the quantity, at the next step."""
        reading = self._reading(truth)
        self._line.extend([reading] if self._line else [reading] * self._places)
        held = self._losses is not None and next(self._losses)
        value = self._sample.value if held else self._line[0]
        self._sample = Sample(value, held)
        return self._sample

    def _reading(self, truth: float) -> float:
        """Return s_k: the value before delay and dropout."""
        value = self._gain * truth + self._bias
        if self._normal is not None:
            value += self._noise * next(self._normal)
        if not self._quantum or math.isinf(value):  # a loop that diverges
            return value
        # The remainder is exact, and no quantum is too small for it.
        return value - math.remainder(value, self._quantum)


class ToothCount:
    """
    The speed of a shaft by the teeth that passed: 2 pi (n_k - n_(k-m)) / (N m T).

    n_k = floor(N theta_k / 2 pi) of N teeth, m periods T of 10 ms. One tooth is at the sensor at
    t_0, and before t_0 the shaft has its speed of t_0. The sign is that of the speed.
    """

    def __init__(self, teeth: int, periods: int) -> None:
        """Count `teeth` per turn over `periods` of 10 ms."""
        self._teeth_per_rad = teeth / (2.0 * math.pi)
        self._speed_per_tooth = 2.0 * math.pi / (teeth * periods * PERIOD_S)
        self._counts: deque[int] = deque(maxlen=1 + periods)
        self._periods = periods

    def take(self, position: float, speed: float) -> float:
        """Return the counted speed in rad/s at the next step, for theta in rad and w in rad/s."""
        if not self._counts:
            before = range(self._periods, 0, -1)
            self._counts.extend(self._count(position - k * PERIOD_S * speed) for k in before)
        self._counts.append(self._count(position))
        return (self._counts[-1] - self._counts[0]) * self._speed_per_tooth

    def _count(self, position: float) -> int:
        return math.floor(position * self._teeth_per_rad)


class ShaftSensor:
    """The sensor of a shaft's speed, which counts teeth if its options give any."""

    def __init__(self, options: SpeedSensor, quantity: str, seed: int) -> None:
        """Make the `Sensor`; with teeth its input is the counted speed instead of the true one."""
        self._sensor = Sensor(options, quantity, seed)
        self._teeth = ToothCount(options.teeth, options.count_steps) if options.teeth else None

    def take(self, position: float, speed: float) -> Sample:
        """Return the measurement in rad/s at the next step, for theta in rad and w in rad/s."""
        if self._teeth is not None and math.isfinite(position):
            speed = self._teeth.take(position, speed)
        return self._sensor.take(speed)


def gaussian(seed: int, quantity: str) -> Iterator[float]:
    """Yield random numbers of the standard normal distribution, one for each step."""
    random = _generator(seed, quantity, 'noise')
    while True:
        yield from random.standard_normal(_BLOCK).tolist()


def gaussians(seed: int, quantity: str, count: int) -> np.ndarray:
    """Return the first numbers of `gaussian`, (count,)."""
    return _generator(seed, quantity, 'noise').standard_normal(count)


def losses(seed: int, quantity: str, options: SensorOptions) -> Iterator[bool]:
    """
    Yield for each step whether its sample is lost; the sample of step 0 never is.

    A chain of two states (Gilbert 1960) with the share p lost and runs of mean length L: a lost
    sample is followed by a lost one with probability 1 - 1/L, a received one with
    p / ((1 - p) L). With L = 1 / (1 - p) both are p: the losses are independent.
    """
    share = options.dropout
    burst = options.dropout_burst or 1.0 / (1.0 - share)
    go_on, begin = 1.0 - 1.0 / burst, share / ((1.0 - share) * burst)
    random = _generator(seed, quantity, 'dropout')
    lost = False
    yield lost
    while True:
        for draw in random.random(_BLOCK).tolist():
            lost = draw < (go_on if lost else begin)
            yield lost


def _generator(seed: int, quantity: str, purpose: str) -> np.random.Generator:
    """Return the generator of one quantity and purpose, independent of all other generators."""
    stream = zlib.crc32(f'{quantity} {purpose}'.encode())
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, stream])))
