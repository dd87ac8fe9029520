# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The interface of the controllers of many runs, the counterpart of `Controller`."""

from abc import ABC, abstractmethod
from collections.abc import Hashable, Sequence
from typing import Any, ClassVar, NamedTuple, Protocol, Self

import numpy as np

from ddct_controllers.interface import Controller
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.settings import KnownSettings


class Measured(NamedTuple):
    """
    Signals that the controllers of R runs receive at step k: the fields of `Measurement`.

    Values are (R,) in the units of `Measurement`.
    """

    step: int
    """Step k, the same in all runs."""
    engine_speed: np.ndarray
    shaft_speed: np.ndarray
    wheel_speed: np.ndarray
    vehicle_speed: np.ndarray
    engine_torque: np.ndarray
    slip_reference: np.ndarray
    """Slip references in rad/s, (R, P + 1), P the `preview_steps` of all these controllers."""
    slip_reference_rate: np.ndarray
    """Rates of the slip references in rad/s^2, (R, P + 1)."""
    load_torque: np.ndarray
    open_loop_torque: np.ndarray
    on: np.ndarray
    """Whether feedback is on, (R,) of bool; the others pass the period as in `hold`."""

    @classmethod
    def of_plants(cls, observation: Any, speeds: np.ndarray, rates: np.ndarray) -> Self:
        """Return the signals of the plants at a step, before the architecture completes them."""
        measured, none = observation.tick.measured, np.zeros(len(speeds))
        return cls(
            observation.tick.step,
            measured.engine_speed,
            measured.shaft_speed,
            measured.wheel_speed,
            measured.vehicle_speed,
            observation.engine_torque,
            speeds,
            rates,
            none,
            none,
            none.astype(bool),
        )

    def of_rows(self, rows: 'slice | np.ndarray', preview_steps: int) -> Self:
        """Return the signals of some of the runs, whose controllers look ahead as many steps."""
        previews = (self.slip_reference, self.slip_reference_rate)
        speeds, rates = (
            np.ascontiguousarray(each[rows, : preview_steps + 1]) for each in previews
        )
        return self._replace(
            **{name: getattr(self, name)[rows] for name in _OF_ONE_TIME},
            slip_reference=speeds,
            slip_reference_rate=rates,
        )

    @property
    def slip_speed(self) -> np.ndarray:
        """Slip speeds w_d = w_m - w_p in rad/s, (R,)."""
        return self.engine_speed - self.shaft_speed

    @property
    def present_reference(self) -> np.ndarray:
        """Slip references of this step in rad/s, (R,)."""
        return self.slip_reference.take(0, axis=1)

    @property
    def present_reference_rate(self) -> np.ndarray:
        """Their rates in rad/s^2, (R,)."""
        return self.slip_reference_rate.take(0, axis=1)

    @property
    def slip_error_rpm(self) -> np.ndarray:
        """Slip references less slip speeds in rpm, (R,)."""
        error: np.ndarray = rpm_from_rad_s(self.present_reference - self.slip_speed)
        return error


_OF_ONE_TIME = tuple(
    name
    for name in Measured._fields
    if name not in {'step', 'slip_reference', 'slip_reference_rate'}
)
"""Fields of `Measured` that are (R,)."""


class Feedback(Protocol):
    """Feedback of R runs."""

    def update(self, measured: Measured) -> np.ndarray:
        """Advance by one period; return the feedback torques in N m, (R,)."""
        ...


class StackedController(ABC):
    """
    Controllers of R runs of one kind, each in the state after a reset.

    A subclass has to give each run the torques of its controller step by step, to rounding, and
    independent of the other runs to the last bit.
    """

    fallbacks: ClassVar[int | None] = None
    """Steps at which a program had no solution, 0 in a batch; None for those without programs."""

    @classmethod
    @abstractmethod
    def takes(cls, controller: Controller) -> bool:
        """Return whether this kind is for the class of a controller."""

    @classmethod
    @abstractmethod
    def why_not(cls, controller: Controller) -> str:
        """Return in one line why a controller of that class is not taken, empty if it is."""

    @classmethod
    @abstractmethod
    def key(cls, controller: Controller) -> Hashable:
        """Return what controllers of this kind that are computed together share."""

    @classmethod
    @abstractmethod
    def of(cls, controllers: Sequence[Controller], known: Sequence[KnownSettings]) -> Self:
        """Return the stack of the controllers of R runs with these known settings."""

    @abstractmethod
    def update(self, measured: Measured) -> np.ndarray:
        """
        Advance by one period; return the feedback torques in N m, (R,).

        They are 0 where `measured.on` is not set; there it does what `hold` of its controllers
        does.
        """
