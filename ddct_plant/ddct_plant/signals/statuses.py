# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Adapter for DiagnosticArray, and what its statuses say: pairs, lost samples, clutch phase."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, ClassVar, NamedTuple

from ddct_plant.base.errors import DdctError, require_number
from ddct_plant.models.driveline import PHASE_EVENTS, PHASES, PhaseEvent
from ddct_plant.signals.message_kind import ClassOf, MessageKind

OK, ERROR, STALE = 0, 2, 3
"""Levels of a DiagnosticStatus, as its definition numbers them."""
Pairs = Sequence[tuple[str, str]]
"""Keys and values of a status."""


class Status(NamedTuple):
    """One status of a message."""

    name: str
    level: int = OK
    pairs: Pairs = ()


class StatusForm(ABC):
    """What the statuses of a topic say: values as levels and pairs, and back."""

    @property
    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """Names of the statuses; '' for one that a message names itself."""

    @abstractmethod
    def statuses(self, *values: Any) -> Sequence[Status]:
        """Return the status of each of `names` for values."""

    @abstractmethod
    def values(self, statuses: Sequence[Status]) -> tuple[Any, ...]:
        """Return the values that statuses carry; raise LookupError for one that is missing."""

    def read(self, topic: str, statuses: Sequence[Status]) -> Any:
        """Return the values for a node; raise DdctError for values unfit for the loop."""
        return self.values(statuses)


@dataclass(frozen=True)
class Statuses(MessageKind):
    """Adapter for a DiagnosticArray; the values of its statuses are those of a form."""

    numbers_alone: ClassVar[bool] = False
    form: StatusForm
    type: str = 'diagnostic_msgs/msg/DiagnosticArray'

    def filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        """Return a function that sets levels and pairs; a message may get a name and an error."""
        new_status = class_of('diagnostic_msgs/msg/DiagnosticStatus')
        new_pair = class_of('diagnostic_msgs/msg/KeyValue')
        made = message.status = [new_status(name=name) for name in self.form.names]
        # In rclpy a level is one byte, in the messages of the MCAP library a number.
        as_bytes = bool(made) and isinstance(made[0].level, bytes)

        def fill(*values: Any, name: str = '', error: str = '') -> None:
            for status, (_, level, pairs) in zip(made, self.form.statuses(*values), strict=True):
                status.level = bytes([level]) if as_bytes else level
                if len(status.values) != len(pairs):
                    status.values = [new_pair() for _ in pairs]
                for pair, (key, value) in zip(status.values, pairs, strict=True):
                    pair.key, pair.value = key, value
            if name:
                made[0].name = name
            if error:
                made[0].level, made[0].message = bytes([ERROR]) if as_bytes else ERROR, error

        return fill

    def values(self, message: Any) -> tuple[Any, ...]:
        """Return the values; raise LookupError where a status is missing."""
        return self.form.values(_statuses(message))

    def read(self, topic: str, message: Any) -> Any:
        """Return the values for a node; raise DdctError for values unfit for the loop."""
        return self.form.read(topic, _statuses(message))


def _statuses(message: Any) -> list[Status]:
    return [
        Status(
            status.name,
            status.level[0] if isinstance(status.level, bytes) else status.level,
            [(pair.key, pair.value) for pair in status.values],
        )
        for status in message.status
    ]


@dataclass(frozen=True)
class PairsForm(StatusForm):
    """One status; its value are the (key, value) pairs."""

    names: tuple[str, ...] = ('',)

    def statuses(self, pairs: Pairs) -> Sequence[Status]:
        """Return the status with these pairs."""
        return (Status(self.names[0], OK, pairs),)

    def values(self, statuses: Sequence[Status]) -> tuple[tuple[tuple[str, str], ...]]:
        """Return the pairs."""
        return (tuple(statuses[0].pairs),)

    def read(self, topic: str, statuses: Sequence[Status]) -> tuple[str, dict[str, str]]:
        """Return the name of the status, and the pairs; raise DdctError without a status."""
        if not statuses:
            raise DdctError(f'{topic} has no status: it needs one, with pairs', key=topic)
        return statuses[0].name, dict(statuses[0].pairs)


@dataclass(frozen=True)
class FlagsForm(StatusForm):
    """
    A status for each sample of a sensor: STALE where the last value is repeated, else OK.

    A value is the flag, 1 or 0, of one sample, or a row of flags of several.
    """

    samples: tuple[tuple[str, ...], ...]
    """Names of the statuses by value; a value with several names is a row of flags."""

    @property
    def names(self) -> tuple[str, ...]:
        """The names in their order."""
        return tuple(chain(*self.samples))

    def statuses(self, *values: Any) -> Sequence[Status]:
        """Return the statuses for flags."""
        flags: list[float] = []
        for names, value in zip(self.samples, values, strict=True):
            flags.extend(value if len(names) > 1 else (value,))
        return [
            Status(name, STALE if flag else OK)
            for name, flag in zip(self.names, flags, strict=True)
        ]

    def values(self, statuses: Sequence[Status]) -> tuple[Any, ...]:
        """Return the flags; raise LookupError where a status is missing."""
        flags = {status.name: float(status.level == STALE) for status in statuses}
        return tuple(
            [flags[name] for name in names] if len(names) > 1 else flags[names[0]]
            for names in self.samples
        )


FRICTION_WORK, TIE_UP_WORK = _WORKS = 'friction_work_j', 'tie_up_work_j'
"""Keys of the works in J that a report on a clutch may have after its phase, in their order."""
_ACCELERATION = 'slip_acceleration_rad_s2'


@dataclass(frozen=True)
class PhaseForm(StatusForm):
    """
    A status on the clutch, as text: phase, works, events at slip zero.

    Each event has one pair of kind and time, and one pair of its slip acceleration after it.
    """

    works: tuple[str, ...] = (FRICTION_WORK,)
    """Keys of the works of which it has values; a message may have others too."""
    names: tuple[str, ...] = ('clutch',)

    def statuses(self, phase: float, *works_and_events: Any) -> Sequence[Status]:
        """Return the status for the number of a phase, works in J, and events."""
        *works, events = works_and_events
        pairs = [('phase', PHASES[int(phase)])]
        pairs += [(key, repr(float(work))) for key, work in zip(self.works, works, strict=True)]
        for event in events:
            pairs.append((event.kind, repr(event.time_s)))
            if event.slip_acceleration is not None:
                pairs.append((_ACCELERATION, repr(event.slip_acceleration)))
        return (Status(self.names[0], OK, pairs),)

    def values(self, statuses: Sequence[Status]) -> tuple[Any, ...]:
        """Return phase number, works in J and events; raise LookupError for bad ones."""
        pairs = statuses[0].pairs
        try:
            (_, phase), *rest = pairs
            works = {key: float(value) for key, value in rest[: len(_WORKS)] if key in _WORKS}
            events = _events(rest[len(works) :])
            return float(PHASES.index(phase)), *(works[key] for key in self.works), events
        except (ValueError, KeyError):
            raise LookupError(f'its status holds {pairs}') from None

    def read(self, topic: str, statuses: Sequence[Status]) -> float:
        """Return the friction work in J; raise DdctError unless finite and not negative."""
        try:
            _, work, *_ = self.values(statuses)
        except LookupError as error:
            raise DdctError(
                f'{topic}: {error}: it needs phase, {", ".join(self.works)}, then the events',
                key=topic,
            ) from error
        return require_number(topic, work, at_least=0.0)


def _events(pairs: Pairs) -> tuple[PhaseEvent, ...]:
    """Return the events; older bags have no accelerations. Raise ValueError for a bad pair."""
    events: list[PhaseEvent] = []
    for key, value in pairs:
        number = float(value)
        if key in PHASE_EVENTS:
            events.append(PhaseEvent(number, key))
        elif key == _ACCELERATION and events and events[-1].slip_acceleration is None:
            events[-1] = events[-1]._replace(slip_acceleration=number)
        else:
            raise ValueError
    return tuple(events)
