# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Declaration of sensors: the quantities of a topic of sensors, and the flags of lost samples."""

from dataclasses import dataclass

from ddct_plant.signals.signal import Signal


@dataclass(frozen=True)
class SensedQuantity:
    """Quantity that a sensor measures; options, random numbers and model of the sensor follow."""

    sensor: str
    """Name of the sensor: the key of its options below `sensors.`, and of its random numbers."""
    true: str
    """Name of the true quantity."""
    measured: str
    """Name of the measured quantity."""
    flag: str
    """Name of the flag of a repeated sample."""
    angle: str = ''
    """Name of the angle of the shaft, for a sensor that may count teeth; else ''."""


@dataclass(frozen=True)
class Sensed:
    """Sensors of a topic, and the flags of their repeated samples."""

    quantities: tuple[SensedQuantity, ...]
    """Quantities that a sensor measures; none where the signal is computed from other sensors."""
    flags: Signal
    """Signal with a flag for each value: 1 where the last value is repeated, else 0."""
    statuses: tuple[str, ...]
    """Names of the diagnostic statuses of the flags."""


REPEATED = '1 where the last value is repeated, else 0'
"""Meaning of a flag."""
