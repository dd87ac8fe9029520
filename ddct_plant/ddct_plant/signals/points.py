# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Adapters for JointTrajectory: torques within a period, and previews."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.timebase import PERIOD_NS, SUBSTEP_NS, SUBSTEPS
from ddct_plant.hybrid.friction_system import require_capacities
from ddct_plant.signals.message_kind import ClassOf, MessageKind, set_time, signal_values


@dataclass(frozen=True)
class Points(MessageKind):
    """
    Adapter for a JointTrajectory: a row of points, one number per point, field and joint.

    A message has the first joints only, if values for fewer joints are given.
    """

    joints: tuple[str, ...]
    fields: tuple[str, ...]
    """Fields that are filled: some of 'velocities', 'accelerations' and 'effort'."""
    spacing_ns: int
    """Time between two points in ns."""
    count: int | None = None
    """Number of points; None takes that of the first message of a writer."""

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        columns: list[tuple[int, list[Any]]] = []

        def fill(*values: Sequence[float]) -> None:
            if not columns:
                joints = self.joints[: len(values) // len(self.fields)]
                message.joint_names = list(joints)
                message.points = self._points(
                    class_of('trajectory_msgs/msg/JointTrajectoryPoint'),
                    self.count or len(values[0]),
                    len(joints),
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
        return self._rows(self._columns(message.points), len(message.joint_names))

    def _columns(self, points: Sequence[Any]) -> list[list[Sequence[float]]]:
        """Return for each field the numbers of each point, one for each joint."""
        return [[getattr(point, field) for point in points] for field in self.fields]

    def _rows(self, columns: Sequence[Any], joints: int) -> tuple[list[float], ...]:
        return tuple(
            [numbers[joint] for numbers in column] for column in columns for joint in range(joints)
        )

    def _one_each(self, columns: Sequence[Any], joints: int) -> bool:
        """Return whether each point has one number per field and joint."""
        return all(len(numbers) == joints for column in columns for numbers in column)


@dataclass(frozen=True)
class TorqueRows(Points):
    """Adapter for torques in N m at 0, 1, ..., 10 ms after the stamp, or for two capacities."""

    fields: tuple[str, ...] = ('effort',)
    spacing_ns: int = SUBSTEP_NS
    count: int | None = SUBSTEPS + 1

    def read(self, topic: str, message: Any, joints: int = 1) -> list[list[float]]:
        """
        Return the (11,) torques in N m of each joint.

        Raise DdctError unless there are `joints` joints, all torques are within MOST_SIGNAL and,
        of two joints, 0 <= kinetic <= static.
        """
        needed = list(self.joints[:joints])
        if list(message.joint_names) != needed:
            raise DdctError(
                f'{topic} has the joints {", ".join(message.joint_names) or "(none)"}: this run '
                f'needs {", ".join(needed)}; start every node with the same clutch',
                key=topic,
            )
        points = message.points
        columns = self._columns(points)
        if len(points) != self.count or not self._one_each(columns, joints):
            raise DdctError(
                f'{topic} has {len(points)} points: it needs {self.count}, '
                '1 ms apart, each with an effort for each joint and no more'
            )
        rows = [signal_values(topic, row) for row in self._rows(columns, joints)]
        try:
            if joints > 1:
                require_capacities(0, *rows)
        except ParameterError as error:
            raise ParameterError(f'{topic}: {error}', key=topic) from error
        return rows


@dataclass(frozen=True)
class PreviewPoints(Points):
    """Adapter for a preview of a speed in rad/s and its rate in rad/s^2, every 10 ms ahead."""

    fields: tuple[str, ...] = ('velocities', 'accelerations')
    spacing_ns: int = PERIOD_NS

    def read(
        self, topic: str, message: Any, preview_steps: int = 0
    ) -> tuple[list[float], list[float]]:
        """
        Return speeds and rates, (preview_steps + 1,) each.

        Raise DdctError for another joint, a value that no signal has or a preview that is too
        short.
        """
        if tuple(message.joint_names) != self.joints:
            raise DdctError(
                f'{topic} has the joints {", ".join(message.joint_names) or "(none)"}: it needs '
                f'{", ".join(self.joints)}',
                key=topic,
            )
        points = message.points
        if len(points) <= preview_steps:
            raise DdctError(
                f'{topic} has {len(points)} points and the controller needs '
                f'{preview_steps + 1}: start the reference with '
                f'--ros-args -p preview_steps:={preview_steps}',
                key=topic,
            )
        columns = self._columns(points)
        if not self._one_each(columns, 1):
            raise DdctError(f'{topic}: each point needs one velocity and one acceleration')
        speeds, rates = self._rows(columns, 1)
        last = preview_steps + 1
        return signal_values(topic, speeds[:last]), signal_values(topic, rates[:last])
