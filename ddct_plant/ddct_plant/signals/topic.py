# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A topic: its name, message type and publisher, its signals, and the runs that have it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ddct_plant.signals.message_kind import ClassOf, MessageKind, Write, ros_class
from ddct_plant.signals.sensed import Sensed
from ddct_plant.signals.signal import RunKind, Signal


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
    sensed: Sensed | None = None
    """Sensors that it carries measurements of; None for a topic of others."""
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
