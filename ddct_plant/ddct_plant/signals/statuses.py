# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Adapters for DiagnosticArray: pairs of a status, flags of samples, the phase of the clutch."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from ddct_plant.base.errors import DdctError, require_number
from ddct_plant.models.driveline import PHASE_EVENTS, PHASES, PhaseEvent
from ddct_plant.signals.message_kind import ClassOf, MessageKind


@dataclass(frozen=True)
class Status(MessageKind):
    """Adapter for a DiagnosticArray with one status: its name and (key, value) pairs."""

    numbers_alone: ClassVar[bool] = False
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
        """Return the name of the status, and the pairs; raise DdctError without a status."""
        if not message.status:
            raise DdctError(f'{topic} has no status: it needs one, with pairs', key=topic)
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

    numbers_alone: ClassVar[bool] = False
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


FRICTION_WORK, TIE_UP_WORK = _WORKS = 'friction_work_j', 'tie_up_work_j'
"""Keys of the works in J that a report on a clutch may have after its phase, in their order."""


@dataclass(frozen=True)
class PhaseReport(MessageKind):
    """
    Adapter for a DiagnosticArray on the clutch: phase, works, events at slip zero.

    Each event has one pair of kind and time, and one pair of its slip acceleration after it.
    """

    numbers_alone: ClassVar[bool] = False
    works: tuple[str, ...] = (FRICTION_WORK,)
    """Keys of the works of which it has values; a message may have others too."""
    _ACCELERATION: ClassVar[str] = 'slip_acceleration_rad_s2'

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        fill_pairs = Status(self.type, 'clutch')._filler(message, class_of)

        def fill(phase: float, *works_and_events: Any) -> None:
            *works, events = works_and_events
            pairs = [('phase', PHASES[int(phase)])]
            pairs += [
                (key, repr(float(work))) for key, work in zip(self.works, works, strict=True)
            ]
            for event in events:
                pairs.append((event.kind, repr(event.time_s)))
                if event.slip_acceleration is not None:
                    pairs.append((self._ACCELERATION, repr(event.slip_acceleration)))
            fill_pairs(pairs)

        return fill

    def values(self, message: Any) -> tuple[Any, ...]:
        """Return phase number, works in J and events; raise LookupError for bad ones."""
        pairs = [(pair.key, pair.value) for pair in message.status[0].values]
        try:
            (_, phase), *rest = pairs
            works = {key: float(value) for key, value in rest[: len(_WORKS)] if key in _WORKS}
            events = self._events(rest[len(works) :])
            return float(PHASES.index(phase)), *(works[key] for key in self.works), events
        except (ValueError, KeyError):
            raise LookupError(f'its status holds {pairs}') from None

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
            _, work, *_ = self.values(message)
        except LookupError as error:
            raise DdctError(
                f'{topic}: {error}: it needs phase, {", ".join(self.works)}, then the events',
                key=topic,
            ) from error
        return require_number(topic, work, at_least=0.0)
