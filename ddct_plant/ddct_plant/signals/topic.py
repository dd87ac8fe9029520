# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A topic, its signals, and the kinds of runs that have them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ddct_plant.base.clutch_kinds import LINEAR, STICK_SLIP
from ddct_plant.signals.message_kind import ClassOf, MessageKind, Write, ros_class

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


def if_two_input(run: RunKind) -> bool:
    """Return whether the controller of a run also commands the engine."""
    return run.two_input


def if_stick_slip(run: RunKind) -> bool:
    """Return whether the clutch of a run sticks and slips."""
    return run.clutch == STICK_SLIP


def if_sensed(run: RunKind) -> bool:
    """Return whether a run has sensors."""
    return run.sensed


def if_shift(run: RunKind) -> bool:
    """Return whether a run is a gear shift."""
    return run.shift


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


@dataclass(frozen=True, eq=False)
class Topic:
    """One topic: its name, message kind, publisher and signals."""

    name: str
    """Name that nodes use: relative, except `/clock` and `/diagnostics`."""
    kind: MessageKind
    """Adapter for its message type."""
    publisher: str
    """Name of the node that publishes it."""
    signals: tuple[Signal, ...] = ()
    """Signals, one for each value of a message."""
    frame: str = ''
    """Coordinate frame of its values; '' for values that have none, as diagnostics."""
    every_tick: bool = True
    """Whether a lock-step run has exactly one message per tick, from one publisher."""
    latched: bool = False
    """Whether its durability is transient local, with depth 1."""
    wall_clock: bool = False
    """Whether it carries wall-clock values, which a lock-step recording must not contain."""
    when: Callable[[RunKind], bool] | None = None
    """Condition on the runs that have the topic; None for all of them."""
    optional: bool = False
    """Whether a node in the place of `controller` may leave it out (`RunKind.torque_parts`)."""

    @property
    def type(self) -> str:
        """Name of the message type, such as 'sensor_msgs/msg/JointState'."""
        return self.kind.type

    @property
    def message_class(self) -> Any:
        """The ROS class of its messages."""
        return ros_class(self.kind.type)

    @property
    def resolved_name(self) -> str:
        """The name in a bag, outside any namespace, with its leading slash."""
        return self.name if self.name.startswith('/') else f'/{self.name}'

    @property
    def is_tick(self) -> bool:
        """Whether the owner of time publishes it with every tick; all others are replies."""
        return self.every_tick and self.publisher == 'driveline'

    def in_run(self, run: RunKind) -> bool:
        """Return whether a run has this topic."""
        absent = self.optional and not run.torque_parts
        return not absent and (self.when is None or self.when(run))

    def signals_in(self, run: RunKind) -> tuple[Signal, ...]:
        """Return the signals of this topic in a run that has the topic."""
        return tuple(each for each in self.signals if each.when is None or each.when(run))

    def writer(self, class_of: ClassOf = ros_class) -> Write:
        """Return a function `write(stamp_ns, *values)` that fills one message of its own."""
        return self.kind.writer(class_of, self.frame)

    def message(self, stamp: int, *values: Any, **options: Any) -> Any:
        """Return a new message with a stamp in ns and the values of `signals`."""
        return self.writer()(stamp, *values, **options)

    def values(self, message: Any) -> tuple[Any, ...]:
        """Return the values of `signals` in a message, unchecked."""
        return self.kind.values(message)

    def read(self, message: Any, *, shown: str = '', **options: Any) -> Any:
        """
        Return the values for a node; raise DdctError for values unfit for the loop.

        The error names the topic `shown`, where the node is in a namespace, or else `name`.
        """
        return self.kind.read(shown or self.name, message, **options)
