# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Adapters for the message types of the graph: make, fill and read messages, all in SI units.

ROS is imported only when a message is made, and reading only uses attributes, so that messages of
rclpy and messages decoded from a bag are read alike. Building a message costs 1 to 60 us, filling
one far below 1 us, so a writer keeps one message and fills it anew for every tick.
"""

import importlib
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from operator import attrgetter
from typing import Any, ClassVar, NamedTuple

from ddct_plant.base.errors import MOST_SIGNAL, require_number, require_signal

NS_PER_S = 1_000_000_000
Write = Callable[..., Any]
"""Function `write(stamp_ns, *values)`: fills the one message that it keeps, and returns it."""
ClassOf = Callable[[str], Any]
"""Function from the name of a message type to its class: `ros_class`, or one without ROS."""


def ros_class(type_name: str) -> Any:
    """Return the ROS class of a type such as 'sensor_msgs/msg/JointState'."""
    package, kind, name = type_name.split('/')
    return getattr(importlib.import_module(f'{package}.{kind}'), name)


def stamp_ns(message: Any) -> int:
    """Return the stamp in ns of a message with a header, of a Header, of a Clock or of a Time."""
    time = _time_of(message)
    return time.sec * NS_PER_S + time.nanosec


def set_time(time: Any, time_ns: int) -> None:
    """Set a Time or a Duration to `time_ns` in ns."""
    time.sec, time.nanosec = divmod(time_ns, NS_PER_S)


def _time_of(message: Any) -> Any:
    header = getattr(message, 'header', message)
    return getattr(header, 'stamp', None) or getattr(message, 'clock', message)


class MessageKind(ABC):
    """Adapter for the messages of one kind of content."""

    numbers_alone: ClassVar[bool] = True
    """Whether the values are numbers, or rows of them: always as many, and all float64."""
    type: str
    """Name of the message type, such as 'sensor_msgs/msg/JointState'."""

    def writer(self, class_of: ClassOf = ros_class, frame: str = '') -> Write:
        """
        Return a function that fills one message of its own, from values as of `values`.

        `frame` is the coordinate frame of the values, '' for values without one.
        """
        message = class_of(self.type)()
        if frame:
            message.header.frame_id = frame
        time, fill = _time_of(message), self.filler(message, class_of)

        def write(stamp: int, *values: Any, **options: Any) -> Any:
            set_time(time, stamp)
            fill(*values, **options)
            return message

        return write

    @abstractmethod
    def filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        """Return a function that sets the values of the new `message` and of its parts."""

    @abstractmethod
    def values(self, message: Any) -> tuple[Any, ...]:
        """Return the values in a message, unchecked."""

    @abstractmethod
    def read(self, topic: str, message: Any) -> Any:
        """Return the values for a node; raise DdctError for values unfit for the loop."""


class Number(NamedTuple):
    """A number of a message, and the values of it that a node accepts."""

    field: str
    at_least: float | None = None
    """Lowest accepted value, None for -MOST_SIGNAL."""
    at_most: float = MOST_SIGNAL
    """Highest accepted value."""

    @property
    def check(self) -> Callable[[str, float], float]:
        """Function of a topic and a value that returns the value, or raises DdctError for it."""
        if self.at_least is None:
            return require_signal
        return partial(require_number, at_least=self.at_least, at_most=self.at_most)


@dataclass(frozen=True)
class Numbers(MessageKind):
    """Adapter for a message with a few numbers in one part of it, or with its stamp alone."""

    type: str
    part: str = ''
    """Path of the part with the numbers, such as 'twist.angular'; '' for the message itself."""
    numbers: tuple[Number, ...] = ()
    of: Callable[..., Any] | None = None
    """What a node makes of several numbers; None for one number, or none."""

    def filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        """Return a function that sets the numbers of the new `message`."""
        part = attrgetter(self.part)(message) if self.part else message
        fields = [number.field for number in self.numbers]

        def fill(*values: float) -> None:
            for field, value in zip(fields, values, strict=True):
                setattr(part, field, value)

        return fill

    @cached_property
    def _get(self) -> Callable[[Any], Any]:
        """Function that returns the number in a message, or a tuple of several."""
        prefix = f'{self.part}.' if self.part else ''
        fields = [number.field for number in self.numbers]
        if len(fields) == 1:
            return attrgetter(prefix + fields[0])
        # A message decodes a part anew whenever it is asked for it.
        part, numbers = attrgetter(self.part), attrgetter(*fields)
        return lambda message: numbers(part(message))

    @cached_property
    def _checks(self) -> list[Callable[[str, float], float]]:
        return [number.check for number in self.numbers]

    def values(self, message: Any) -> tuple[float, ...]:
        """Return the numbers."""
        if not self.numbers:
            return ()
        found = self._get(message)
        return found if len(self.numbers) > 1 else (found,)

    def read(self, topic: str, message: Any) -> Any:
        """
        Return the number, what `of` makes of several, or None for a stamp alone.

        Raise DdctError for a number that is not that of a signal, or beyond its bounds.
        """
        if not self.numbers:
            return None
        if self.of is None:
            return self._checks[0](topic, self._get(message))
        values = zip(self._checks, self._get(message), strict=True)
        return self.of(*[check(topic, value) for check, value in values])


def signal_values(topic: str, values: Sequence[float]) -> list[float]:
    """Return the values of a message on `topic`; raise DdctError as `require_signal` does."""
    # One call for every message: what is within the bound together is so each by itself.
    if not math.hypot(*values) <= MOST_SIGNAL:
        for value in values:
            require_signal(topic, value)
    return list(values)
