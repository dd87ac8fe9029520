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
from array import array
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import Any, ClassVar

from ddct_plant.base.errors import DdctError, ParameterError, require_finite, require_number
from ddct_plant.base.timebase import PERIOD_NS, SUBSTEP_NS, SUBSTEPS
from ddct_plant.hybrid.friction_system import require_capacities
from ddct_plant.models.driveline import PHASE_EVENTS, PHASES, PhaseEvent

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


@dataclass(frozen=True)
class MessageKind:
    """Adapter for one message type; this base carries the stamp only."""

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
        time, fill = _time_of(message), self._filler(message, class_of)

        def write(stamp: int, *values: Any, **options: Any) -> Any:
            set_time(time, stamp)
            fill(*values, **options)
            return message

        return write

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        """Return a function that sets the values of the new `message` and of its parts."""
        return lambda: None

    def values(self, message: Any) -> tuple[Any, ...]:
        """Return the values in a message, unchecked."""
        return ()

    def read(self, topic: str, message: Any) -> Any:
        """Return the values for a node; raise DdctError for values unfit for the loop."""


@dataclass(frozen=True)
class Scalar(MessageKind):
    """Adapter for one number."""

    path: str
    """Path of the number in the message, such as 'twist.angular.x'."""
    at_least: float | None = None
    """Lowest value that a node accepts, None for no bound."""

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        parent, _, field = self.path.rpartition('.')
        holder = attrgetter(parent)(message) if parent else message

        def fill(value: float) -> None:
            setattr(holder, field, value)

        return fill

    @cached_property
    def _get(self) -> Callable[[Any], float]:
        return attrgetter(self.path)

    def values(self, message: Any) -> tuple[float]:
        """Return the number."""
        return (self._get(message),)

    def read(self, topic: str, message: Any) -> float:
        """Return the number; raise DdctError unless finite and high enough."""
        if self.at_least is None:
            return require_finite(topic, self._get(message))
        return require_number(topic, self._get(message), at_least=self.at_least)


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

    def read(self, topic: str, message: Any) -> list[float]:
        """Return the speeds; raise DdctError unless there is a finite one for each joint."""
        return _finite(topic, self._speeds(topic, message))

    def _speeds(self, topic: str, message: Any) -> Sequence[float]:
        names = list(self.names)
        if list(message.name) != names or len(message.velocity) != len(names):
            raise DdctError(
                f'{topic} names {list(message.name)} with {len(message.velocity)} velocities: '
                f'it needs one velocity for each of {names}, in this order'
            )
        return message.velocity


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
        """Return the torques in N m; raise LookupError where a name or an effort is missing."""
        torques = dict(zip(message.name, message.effort, strict=False))
        return tuple(torques[name] for name in self.names)


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
        points = message.points
        joints = range(len(message.joint_names))
        return tuple(
            [getattr(point, field)[joint] for point in points]
            for field in self.fields
            for joint in joints
        )


@dataclass(frozen=True)
class TorqueRows(Points):
    """Adapter for torques in N m at 0, 1, ..., 10 ms after the stamp, or for two capacities."""

    fields: tuple[str, ...] = ('effort',)
    spacing_ns: int = SUBSTEP_NS
    count: int | None = SUBSTEPS + 1

    def read(self, topic: str, message: Any, joints: int = 1) -> list[list[float]]:
        """
        Return the (11,) torques in N m of each joint.

        Raise DdctError unless there are `joints` joints, all torques are finite and, of two
        joints, 0 <= kinetic <= static.
        """
        needed = list(self.joints[:joints])
        if list(message.joint_names) != needed:
            raise DdctError(
                f'{topic} has the joints {", ".join(message.joint_names) or "(none)"}: this run '
                f'needs {", ".join(needed)}; start every node with the same clutch'
            )
        try:
            values = self.values(message)
        except IndexError:
            values = ()
        if not values or len(values[0]) != self.count:
            raise DdctError(
                f'{topic} has {len(message.points)} points: it needs {self.count}, '
                '1 ms apart, each with an effort'
            )
        rows = [_finite(topic, row) for row in values]
        try:
            if joints > 1:
                require_capacities(0, *rows)
        except ParameterError as error:
            raise ParameterError(f'{topic}: {error}') from error
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

        Raise DdctError for a value that is not finite or a preview that is too short.
        """
        if len(message.points) <= preview_steps:
            raise DdctError(
                f'{topic} has {len(message.points)} points and the controller needs '
                f'{preview_steps + 1}: start the reference with '
                f'--ros-args -p preview_steps:={preview_steps}'
            )
        try:
            speeds, rates = self.values(message)
        except IndexError:
            raise DdctError(f'{topic}: each point needs a velocity and an acceleration') from None
        last = preview_steps + 1
        return _finite(topic, speeds[:last]), _finite(topic, rates[:last])


@dataclass(frozen=True)
class Status(MessageKind):
    """Adapter for a DiagnosticArray with one status: its name and (key, value) pairs."""

    name: str = ''
    """Name of the status, where it is constant."""

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        new_status = class_of('diagnostic_msgs/msg/DiagnosticStatus')
        status = new_status(name=self.name)
        message.status = [status]
        new_pair = class_of('diagnostic_msgs/msg/KeyValue')

        def fill(pairs: Sequence[tuple[str, str]], *, name: str = '', error: str = '') -> None:
            if name:
                status.name = name
            if error:
                status.level, status.message = new_status.ERROR, error
            if len(status.values) != len(pairs):
                status.values = [new_pair() for _ in pairs]
            for pair, (key, value) in zip(status.values, pairs, strict=True):
                pair.key = key
                pair.value = value

        return fill

    def values(self, message: Any) -> tuple[tuple[tuple[str, str], ...]]:
        """Return the (key, value) pairs."""
        return (tuple((pair.key, pair.value) for pair in message.status[0].values),)

    def read(self, topic: str, message: Any) -> tuple[str, dict[str, str]]:
        """Return the name of the status, and the pairs."""
        return message.status[0].name, dict(*self.values(message))


OK, STALE = 0, 3
"""Levels of a DiagnosticStatus, as its definition numbers them."""


@dataclass(frozen=True)
class SampleFlags(MessageKind):
    """
    Adapter for a DiagnosticArray with one status for each sample of a sensor.

    The level is STALE where the sample was lost and the last value is repeated, else OK. One value
    of a message is the flag, 1 or 0, of one sample, or a row of flags of several.
    """

    names: tuple[tuple[str, ...], ...]
    """Names of the statuses by value; a value with several names is a row of flags."""

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        new_status = class_of('diagnostic_msgs/msg/DiagnosticStatus')
        statuses = [new_status(name=name) for names in self.names for name in names]
        message.status = statuses
        # In rclpy a level is one byte, in the messages of the MCAP library a number.
        as_bytes = isinstance(statuses[0].level, bytes)
        ok, stale = (bytes([OK]), bytes([STALE])) if as_bytes else (OK, STALE)

        def fill(*values: Any) -> None:
            flags: list[float] = []
            for names, value in zip(self.names, values, strict=True):
                flags.extend(value if len(names) > 1 else (value,))
            for status, flag in zip(statuses, flags, strict=True):
                status.level = stale if flag else ok

        return fill

    def values(self, message: Any) -> tuple[Any, ...]:
        """Return the flags; raise LookupError where a status is missing."""
        flags = {status.name: float(_level(status) == STALE) for status in message.status}
        return tuple(
            [flags[name] for name in names] if len(names) > 1 else flags[names[0]]
            for names in self.names
        )


def _level(status: Any) -> int:
    level = status.level
    return level[0] if isinstance(level, bytes) else level


@dataclass(frozen=True)
class PhaseReport(MessageKind):
    """
    Adapter for a DiagnosticArray on the clutch: phase, friction work, events at slip zero.

    Each event has one pair of kind and time, and one pair of its slip acceleration after it.
    """

    _WORK: ClassVar[str] = 'friction_work_j'
    _ACCELERATION: ClassVar[str] = 'slip_acceleration_rad_s2'

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        fill_pairs = Status(self.type, 'clutch')._filler(message, class_of)

        def fill(phase: float, work: float, events: Sequence[PhaseEvent]) -> None:
            pairs = [('phase', PHASES[int(phase)]), (self._WORK, repr(float(work)))]
            for event in events:
                pairs.append((event.kind, repr(event.time_s)))
                if event.slip_acceleration is not None:
                    pairs.append((self._ACCELERATION, repr(event.slip_acceleration)))
            fill_pairs(pairs)

        return fill

    def values(self, message: Any) -> tuple[float, float, tuple[PhaseEvent, ...]]:
        """Return phase number, friction work in J and events; raise LookupError for bad ones."""
        pairs = [(pair.key, pair.value) for pair in message.status[0].values]
        try:
            (_, phase), (key, work), *rest = pairs
            events = self._events(rest)
            if key == self._WORK:
                return float(PHASES.index(phase)), float(work), events
        except ValueError:
            pass
        raise LookupError(f'its status holds {pairs}')

    def _events(self, pairs: Sequence[tuple[str, str]]) -> tuple[PhaseEvent, ...]:
        """Return the events; older bags have no accelerations. Raise ValueError for a bad pair."""
        events: list[PhaseEvent] = []
        for key, value in pairs:
            number = float(value)
            if key in PHASE_EVENTS:
                events.append(PhaseEvent(number, key))
            elif key == self._ACCELERATION and events and events[-1].slip_acceleration is None:
                events[-1] = events[-1]._replace(slip_acceleration=number)
            else:
                raise ValueError
        return tuple(events)

    def read(self, topic: str, message: Any) -> float:
        """Return the friction work in J; raise DdctError unless finite and not negative."""
        try:
            _, work, _ = self.values(message)
        except LookupError as error:
            raise DdctError(
                f'{topic}: {error}: it needs phase, {self._WORK}, then the events'
            ) from error
        return require_number(topic, work, at_least=0.0)


def _finite(topic: str, values: Sequence[float]) -> list[float]:
    if not all(map(math.isfinite, values)):
        for value in values:
            require_finite(topic, value)
    return list(values)
