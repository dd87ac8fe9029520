# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A signal of a run: its name, unit and size, and the runs that have it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ddct_plant.base.clutch_kinds import LINEAR

SignalValue = float | Sequence[float] | tuple[object, ...] | None
"""Value of a signal at one step: a number, several, texts or events; None where a run lacks it."""


@dataclass(frozen=True)
class RunKind:
    """Properties of a run that decide which topics it has; every node and reader has them."""

    lockstep: bool = True
    """Whether the owner of time waits for every reply."""
    two_input: bool = False
    """Whether the controller also commands the engine."""
    clutch: str = LINEAR
    """Name of the clutch model."""
    sensed: bool = False
    """Whether controller and reference read sensors in place of the truth."""
    shift: bool = False
    """Whether the run is a gear shift, with an off-going clutch too."""
    torque_parts: bool = True
    """Whether the controller's node publishes the topics with `Topic.optional`."""


@dataclass(frozen=True)
class Signal:
    """One quantity of a topic, or several of one unit, with one row per tick in a trajectory."""

    name: str
    unit: str
    """SI unit, such as 'rad/s'; '1' for a bare number, '' for a signal that is not numeric."""
    about: str
    """Meaning."""
    size: int | None = 1
    """Number of values in a row; None where it differs from run to run, as for a preview."""
    parts: tuple[str, ...] = ()
    """Names of the values of a row that has several quantities; else empty."""
    when: Callable[[RunKind], bool] | None = None
    """Condition on the runs that have it, among those with its topic; None for all of them."""

    def __post_init__(self) -> None:
        """Raise ValueError where a row does not have one value per name."""
        if self.parts and len(self.parts) != self.size:
            raise ValueError(f'{self.name} has {self.size} values and {len(self.parts)} names')

    @property
    def column(self) -> str:
        """Name of its column in a table: the name, and the unit if it has one."""
        return column_name(self.name, self.unit)

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of its quantities: those of its values, or its own name."""
        return self.parts or (self.name,)


def column_name(name: str, unit: str) -> str:
    """Return the name of a quantity's column in a table: its name, and the unit if it has one."""
    if unit in ('', '1'):
        return name
    return f'{name}_{unit.replace("/", "_").replace(" ", "_").replace("^", "").lower()}'
