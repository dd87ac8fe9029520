# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Adapters for JointState: values by joint, of one shaft, or torques by name."""

import math
from array import array
from collections import namedtuple
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ddct_plant.base.errors import DdctError
from ddct_plant.signals.message_kind import ClassOf, MessageKind, signal_values


@dataclass(frozen=True)
class Joints(MessageKind):
    """Adapter for a JointState: position in rad, speed in rad/s, effort in N m of each joint."""

    names: tuple[str, ...]
    """Names of the joints, in the order of the message."""
    fields: tuple[str, ...] = ('position', 'velocity', 'effort')
    """Fields of the message that are filled."""

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        message.name = list(self.names)
        if 'effort' not in self.fields:
            # NaN is "not measured". rclpy may add bytes to a message that ends in an empty array.
            message.effort = array('d', [math.nan] * len(self.names))

        def fill(*columns: Sequence[float]) -> None:
            for field, numbers in zip(self.fields, columns, strict=True):
                setattr(message, field, array('d', numbers))

        return fill

    def values(self, message: Any) -> tuple[Any, ...]:
        """Return a row of numbers per field; raise DdctError for other joints."""
        if tuple(message.name) != self.names:
            raise DdctError(
                f'the joints are {", ".join(message.name)}, not {", ".join(self.names)}'
            )
        self._speeds('the message', message)
        return tuple(getattr(message, field) for field in self.fields)

    def read(self, topic: str, message: Any) -> Any:
        """Return the speeds by joint; raise DdctError unless each joint has one, of a signal."""
        return self._by_joint(*signal_values(topic, self._speeds(topic, message)))

    @cached_property
    def _by_joint(self) -> Callable[..., Any]:
        """Class of named tuples with a value per joint."""
        return namedtuple('ByJoint', self.names)  # noqa: PYI024 the names are data

    def _speeds(self, topic: str, message: Any) -> Sequence[float]:
        names = list(self.names)
        if list(message.name) != names or len(message.velocity) != len(names):
            raise DdctError(
                f'{topic} names {list(message.name)} with {len(message.velocity)} velocities: '
                f'it needs one velocity for each of {names}, in this order',
                key=topic,
            )
        for field in ('position', 'effort'):
            if len(getattr(message, field)) not in (0, len(names)):
                raise DdctError(
                    f'{topic} has {len(getattr(message, field))} numbers in {field}: '
                    f'it needs none, or one for each of {names}',
                    key=topic,
                )
        return message.velocity


@dataclass(frozen=True)
class OneShaft(MessageKind):
    """Adapter for a JointState of one shaft: angle in rad, speed in rad/s, torque in N m."""

    name: str
    """Name of the joint."""

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        message.name = [self.name]

        def fill(angle: float, speed: float, torque: float) -> None:
            message.position = array('d', (angle,))
            message.velocity = array('d', (speed,))
            message.effort = array('d', (torque,))

        return fill

    def values(self, message: Any) -> tuple[float, float, float]:
        """Return angle, speed and torque; raise DdctError for another joint or further numbers."""
        if list(message.name) != [self.name]:
            raise DdctError(f'the joints are {", ".join(message.name)}, not {self.name}')
        require_one_each(message, ('position', 'velocity', 'effort'))
        return message.position[0], message.velocity[0], message.effort[0]


@dataclass(frozen=True)
class NamedTorques(MessageKind):
    """Adapter for a JointState that has torques alone: one effort in N m for each name."""

    names: tuple[str, ...]
    """Names of the torques, in the order of the values; a message may have another order."""

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        message.name = list(self.names)

        def fill(*torques: float) -> None:
            message.effort = array('d', torques)

        return fill

    def values(self, message: Any) -> tuple[float, ...]:
        """
        Return the torques in N m.

        Raise DdctError unless each name has one effort, and LookupError where a name is missing.
        """
        require_one_each(message, ('effort',))
        torques = dict(zip(message.name, message.effort, strict=True))
        if len(torques) != len(message.name):
            raise DdctError(f'a name comes twice among {", ".join(message.name)}')
        return tuple(torques[name] for name in self.names)


def require_one_each(message: Any, fields: Sequence[str]) -> None:
    """Raise DdctError unless these fields of a JointState have one number for each name."""
    for field in fields:
        if len(numbers := getattr(message, field)) != len(message.name):
            raise DdctError(
                f'a message has {len(numbers)} numbers in {field}: it needs one for each of '
                f'{list(message.name)}'
            )
