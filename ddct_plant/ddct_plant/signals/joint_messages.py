# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Adapters for values by joint: JointState at one instant, JointTrajectory at several."""

import math
from array import array
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.hybrid.friction_system import require_capacities
from ddct_plant.signals.message_kind import ClassOf, MessageKind, set_time, signal_values

STATE_FIELDS = ('position', 'velocity', 'effort')
"""Fields of a JointState: rad, rad/s, N m."""


@dataclass(frozen=True)
class Joints(MessageKind):
    """
    Adapter for a JointState.

    A value is the row of one field with a number for each joint; with `apart` it is one number,
    field by field and in a field joint by joint.
    """

    names: tuple[str, ...]
    """Names of the joints, in the order of the message."""
    fields: tuple[str, ...] = STATE_FIELDS
    """Fields of the message that are filled."""
    apart: bool = False
    """Whether each number is a value of its own; a message may then have another order, and
    further names."""
    of: Callable[..., Any] | None = None
    """What a node makes of the speeds in the order of the names; None for their list."""
    type: str = 'sensor_msgs/msg/JointState'

    def filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        """Return a function that sets the fields of the new `message`."""
        message.name = list(self.names)
        if 'effort' not in self.fields:
            # NaN is "not measured". rclpy may add bytes to a message that ends in an empty array.
            message.effort = array('d', [math.nan] * len(self.names))
        count, apart = len(self.names), self.apart

        def fill(*values: Any) -> None:
            rows: Sequence[Any] = values
            if apart:
                rows = [values[i : i + count] for i in range(0, len(values), count)]
            for field, numbers in zip(self.fields, rows, strict=True):
                setattr(message, field, array('d', numbers))

        return fill

    def values(self, message: Any) -> tuple[Any, ...]:
        """Return the values; raise DdctError for other joints, or not one number for each."""
        names, order = list(message.name), None
        if names != list(self.names):
            order = self._order(names)
        rows = []
        for field in self.fields:
            if len(row := getattr(message, field)) != len(names):
                raise DdctError(
                    f'a message has {len(row)} numbers in {field}: it needs one for each of '
                    f'{names}'
                )
            rows.append(row if order is None else [row[place] for place in order])
        return tuple(chain(*rows)) if self.apart else tuple(rows)

    def _order(self, names: list[str]) -> list[int]:
        """Return the place of each joint among these names; raise DdctError for other joints."""
        if len(set(names)) != len(names):
            raise DdctError(f'a name comes twice among {", ".join(names)}')
        if not self.apart or not set(names) >= set(self.names):
            raise DdctError(f'the joints are {", ".join(names)}, not {", ".join(self.names)}')
        return [names.index(name) for name in self.names]

    def read(self, topic: str, message: Any) -> Any:
        """
        Return the speeds in rad/s, or what `of` makes of them; with `apart` return the values.

        Raise DdctError for other joints, a number that is missing, and one that no signal has.
        """
        if self.apart:
            return signal_values(topic, self.values(message))
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
        speeds = signal_values(topic, message.velocity)
        return speeds if self.of is None else self.of(*speeds)


@dataclass(frozen=True)
class Points(MessageKind):
    """
    Adapter for a JointTrajectory: points in time, each with a number per field and joint.

    A value is the row of one field and joint over the points. A message has the first joints only,
    if values for fewer joints are given.
    """

    joints: tuple[str, ...]
    fields: tuple[str, ...]
    """Fields that are filled: some of 'velocities', 'accelerations' and 'effort'."""
    spacing_ns: int
    """Time between two points in ns."""
    count: int | None = None
    """Number of points; None takes that of the first message of a writer."""
    type: str = 'trajectory_msgs/msg/JointTrajectory'

    def filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        """Return a function that sets the points of the new `message`, made at the first call."""
        columns: list[tuple[int, list[Any]]] = []

        def fill(*values: Sequence[float]) -> None:
            if not columns:
                joints = self.joints[: len(values) // len(self.fields)]
                message.joint_names = list(joints)
                message.points = self._points(
                    class_of(f'{self.type}Point'), self.count or len(values[0]), len(joints)
                )
                columns.extend(
                    (joint, [getattr(point, field) for point in message.points])
                    for field in self.fields
                    for joint in range(len(joints))
                )
            for (joint, column), numbers in zip(columns, values, strict=True):
                for holder, number in zip(column, numbers, strict=True):
                    holder[joint] = number

        return fill

    def _points(self, new: Callable[..., Any], count: int, joints: int) -> list[Any]:
        points = [new(**{field: [0.0] * joints for field in self.fields}) for _ in range(count)]
        for i, point in enumerate(points):
            set_time(point.time_from_start, i * self.spacing_ns)
        return points

    def values(self, message: Any) -> tuple[list[float], ...]:
        """Return a row of numbers per field and joint; raise IndexError where one is missing."""
        return _rows(self._columns(message.points), len(message.joint_names))

    def _columns(self, points: Sequence[Any]) -> list[list[Sequence[float]]]:
        """Return for each field the numbers of each point, one for each joint."""
        return [[getattr(point, field) for point in points] for field in self.fields]

    def read(
        self, topic: str, message: Any, *, joints: int = 1, preview_steps: int = 0
    ) -> tuple[list[float], ...]:
        """
        Return the row of each field and of each of the first `joints`.

        Of points without a fixed number these are the first `preview_steps` + 1. Raise DdctError
        for other joints, a value that no signal has, points that are missing or too many, and two
        rows of torques unless 0 <= kinetic <= static.
        """
        needed = self.joints[:joints]
        if tuple(message.joint_names) != needed:
            hint = 'this run needs {}; start every node with the same clutch'
            raise DdctError(
                f'{topic} has the joints {", ".join(message.joint_names) or "(none)"}: '
                + (hint if len(self.joints) > 1 else 'it needs {}').format(', '.join(needed)),
                key=topic,
            )
        points = message.points
        self._require_count(topic, len(points), preview_steps)
        columns = self._columns(points)
        if not all(len(numbers) == joints for column in columns for numbers in column):
            raise DdctError(
                f'{topic}: each point needs one number in {" and ".join(self.fields)} for each '
                'joint and no more',
                key=topic,
            )
        end = self.count or preview_steps + 1
        rows = tuple(signal_values(topic, row[:end]) for row in _rows(columns, joints))
        try:
            if joints > 1:
                require_capacities(0, *rows)
        except ParameterError as error:
            raise ParameterError(f'{topic}: {error}', key=topic) from error
        return rows

    def _require_count(self, topic: str, found: int, preview_steps: int) -> None:
        if self.count not in (None, found):
            raise DdctError(
                f'{topic} has {found} points: it needs {self.count}, '
                f'{self.spacing_ns / 1e6:g} ms apart',
                key=topic,
            )
        if found <= preview_steps:
            raise DdctError(
                f'{topic} has {found} points and the controller needs '
                f'{preview_steps + 1}: start the reference with '
                f'--ros-args -p preview_steps:={preview_steps}',
                key=topic,
            )


def _rows(columns: Sequence[Sequence[Sequence[float]]], joints: int) -> tuple[list[float], ...]:
    return tuple(
        [numbers[joint] for numbers in column] for column in columns for joint in range(joints)
    )
