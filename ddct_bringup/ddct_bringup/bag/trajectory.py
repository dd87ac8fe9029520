# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Trajectory of one closed-loop run as plain arrays, simulated without ROS or read from a bag."""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.signals.topic import RunKind, Signal, SignalValue, Topic
from ddct_plant.signals.topics import (
    ENGINE_REQUEST,
    OFF_GOING_SLIP,
    SENSED_SLIP,
    TORQUE_PARTS,
    all_signals,
    quantities,
    signals_of,
)


@dataclass(frozen=True, repr=False)
class Trajectory:
    """
    Signals of a run at the stamps t_0..t_N; row k is step k, so N + 1 rows, all SI.

    A signal of `ddct_plant.signals.topics` is an attribute of its name, and so is each quantity
    of a signal that has several, such as `engine_speed` of `joint_speed`. States, slip and vehicle
    signals are valid at t_k (efforts and `vehicle_accel` are left limits); torques, reference
    and request answer t_k and apply over [t_k, t_k+1]. Replies to t_N are kept although
    nothing applied them.
    """

    signals: Mapping[str, Any]
    """
    Values by signal name: (N+1,) or (N+1, n) numbers, or N + 1 texts; only signals of this
    run.
    """

    def __repr__(self) -> str:
        """Return the number of steps and the names of the signals."""
        steps = max(map(len, self.signals.values()), default=0)
        return f'<Trajectory of {steps} steps: {", ".join(self.signals)}>'

    @classmethod
    def of_columns(cls, columns: Mapping[str, Sequence[Any] | np.ndarray]) -> 'Trajectory':
        """Return a trajectory of values by signal name; raise DdctError for uneven sizes."""
        return cls(
            {
                signal.name: _column(signal, columns[signal.name])
                for signal in all_signals()
                if signal.name in columns
            }
        )

    @classmethod
    def of_rows(cls, rows: Sequence[Mapping[str, SignalValue]], kind: RunKind) -> 'Trajectory':
        """
        Return the trajectory of a run of a kind, from its signals by name at each step.

        It has the signals that the table of topics gives this kind of run. Raise DdctError for one
        that the rows lack.
        """
        names = [signal.name for signal in signals_of(kind)]
        if lacking := [name for name in names if rows[0].get(name) is None]:
            raise DdctError(
                f'nothing computes {", ".join(lacking)}, which this run has', key=lacking[0]
            )
        return cls.of_columns({name: [row[name] for row in rows] for name in names})

    def __getattr__(self, name: str) -> Any:
        """
        Return a signal, or a quantity of one that has several; None where the run lacks it.

        Raise AttributeError for an unknown name.
        """
        signals = self.__dict__.get('signals', {})
        if name in signals:
            return signals[name]
        if name in _signal_names():
            return None
        if name not in quantities():
            raise AttributeError(f'there is no signal {name}')
        return self.at_tick(name)

    def at_tick(self, name: str) -> Any:
        """
        Return a quantity with one value per tick, (N+1,): its value at the tick.

        For a preview and for a torque within the period it is the first value of each row. None
        where the run lacks it; raise KeyError for an unknown name.
        """
        signal, index = quantities()[name]
        values = self.signals.get(signal.name)
        return values if values is None or index is None else values[..., index]

    @property
    def two_input(self) -> bool:
        """Whether the controller commanded the engine too, by `engine_torque_request`."""
        return self._has(ENGINE_REQUEST)

    @property
    def sensed(self) -> bool:
        """Whether controller and reference read sensors, which have signals of their own."""
        return self._has(SENSED_SLIP)

    @property
    def shift(self) -> bool:
        """Whether the run is a gear shift, with the signals of an off-going clutch."""
        return self._has(OFF_GOING_SLIP)

    @property
    def torque_parts(self) -> bool:
        """Whether the parts of the torque request are known."""
        return self._has(TORQUE_PARTS)

    def _has(self, topic: Topic) -> bool:
        return all(signal.name in self.signals for signal in topic.signals)

    @property
    def steps(self) -> int:
        """N, the number of periods integrated."""
        return self.slip_speed.shape[-1] - 1

    @property
    def time_s(self) -> np.ndarray:
        """(N+1,) scenario time in s."""
        return np.arange(self.steps + 1) / 100.0

    def sha256(self) -> str:
        """Return the SHA-256 over every array to the last bit and every text."""
        digest = hashlib.sha256()
        for name, value in self.signals.items():
            digest.update(name.encode())
            if isinstance(value, np.ndarray):
                digest.update(repr(value.shape).encode())
                digest.update(np.ascontiguousarray(value, dtype='<f8').tobytes())
            else:
                digest.update(repr(value).encode())
        return digest.hexdigest()


@cache
def _signal_names() -> frozenset[str]:
    return frozenset(signal.name for signal in all_signals())


def _column(signal: Signal, values: Sequence[Any] | np.ndarray) -> Any:
    if not signal.unit:
        return tuple(values)
    try:
        return np.asarray(values, dtype=float)
    except ValueError as error:
        raise DdctError(f'{signal.name} does not have the same size at every stamp') from error
