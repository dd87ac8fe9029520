# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A learnt policy as a controller: numbers in, torques out. It needs numpy alone."""

import reprlib
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from ddct_controllers.interface import Command, Controller
from ddct_controllers.measurement import Measurement
from ddct_plant.base.timebase import time_of_step

OBSERVED = (
    *('time_s', 'engine_speed', 'shaft_speed', 'wheel_speed', 'vehicle_speed'),
    *('engine_torque', 'load_torque', 'open_loop_torque'),
)
"""Names of the first numbers of an observation; after the time, attributes of `Measurement`."""


def observed_names(preview_steps: int = 0) -> tuple[str, ...]:
    """Return the name of each number of an observation with P `preview_steps`, 8 + 2 (P + 1)."""
    ahead = range(preview_steps + 1)
    references = ('slip_reference', 'slip_reference_rate')
    return (*OBSERVED, *(f'{name}_{step}' for name in references for step in ahead))


def observation_of(measurement: Measurement) -> np.ndarray:
    """
    Return what a controller measures at a step as numbers in SI units, (8 + 2 (P + 1),).

    `observed_names` says what they are: the scenario's time, speeds, torques, then the slip
    reference of this step and of P steps ahead, then its rates.
    """
    values = [getattr(measurement, name) for name in OBSERVED[1:]]
    return np.array(
        [
            time_of_step(measurement.step),
            *values,
            *measurement.slip_reference,
            *measurement.slip_reference_rate,
        ]
    )


class PolicyController(Controller):
    """
    A controller that is a policy: `act` takes an observation and returns torques.

        class Mine(PolicyController):
            def act(self, observation):
                return [0.9 * (observation[1] - observation[2])]

    Observation and action are those of the environment `ddct/Launch-v0`. A policy with a memory
    overrides `reset`; one that commands the engine sets `commands_engine`.
    """

    method_names: ClassVar[Mapping[str, str]] = MappingProxyType({'update': 'act'})

    @abstractmethod
    def act(self, observation: np.ndarray) -> Sequence[float] | np.ndarray:
        """
        Return the closed-loop part of the clutch torque in N m, (1,).

        One that commands the engine returns C_m in N m besides, (2,).
        """

    def reset(self) -> None:
        """Return to the state before the first update; here there is none."""

    def update(self, measurement: Measurement) -> Command:
        """Return the command of `act` for what is measured; raise TypeError for other answers."""
        action: Any = self.act(observation_of(measurement))
        try:
            clutch_torque, *others = map(float, action)
        except (TypeError, ValueError):
            raise TypeError(self._unusable(action)) from None
        if len(others) != self.commands_engine:
            raise TypeError(self._unusable(action))
        return Command(clutch_torque, engine_torque=others[0] if others else None)

    def _unusable(self, action: object) -> str:
        needed = (
            'two numbers in a list, as commands_engine is set'
            if self.commands_engine
            else 'one number in a list, or two with commands_engine set'
        )
        return f'act must return {needed}, got {" ".join(reprlib.repr(action).split())}'
