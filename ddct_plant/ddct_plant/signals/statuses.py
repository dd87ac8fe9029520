# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Adapter for DiagnosticArray, and what its statuses say: pairs, lost samples, clutch phase."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, ClassVar

from ddct_plant.base.errors import DdctError, require_number
from ddct_plant.models.driveline import PHASE_EVENTS, PHASES, PhaseEvent
from ddct_plant.signals.message_kind import ClassOf, MessageKind

OK, ERROR, STALE = 0, 2, 3
"""Levels of a DiagnosticStatus, as its definition numbers them."""
Pairs = Sequence[tuple[str, str]]
"""Keys and values of a status."""


class StatusForm(ABC):
    """What the statuses of a topic say: values as levels and pairs, and back."""

    @property
    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """Names of the statuses; '' for one that a message names itself."""

    @abstractmethod
    def contents(self, *values: Any) -> Sequence[tuple[int, Pairs]]:
        """Return level and pairs of each of `names` for values."""

    @abstractmethod
    def values(self, statuses: Sequence[Any]) -> tuple[Any, ...]:
        """Return the values that statuses carry; raise LookupError for one that is missing."""

    def read(self, topic: str, statuses: Sequence[Any]) -> Any:
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
        as_bytes = isinstance(made[0].level, bytes)
        levels = {each: bytes([each]) if as_bytes else each for each in (OK, ERROR, STALE)}
        shown = [OK for _ in made]
        filled: list[list[Any]] = [[] for _ in made]

        def fill(*values: Any, name: str = '', error: str = '') -> None:
            for i, (level, pairs) in enumerate(self.form.contents(*values)):
                if level != shown[i]:
                    made[i].level, shown[i] = levels[level], level
                if not pairs and not filled[i]:
                    continue
                if len(filled[i]) != len(pairs):
                    filled[i] = made[i].values = [new_pair() for _ in pairs]
                for pair, (key, value) in zip(filled[i], pairs, strict=True):
                    pair.key = key
                    pair.value = value
            if name:
                made[0].name = name
            if error:
                made[0].level, made[0].message = levels[ERROR], error

        return fill

    def values(self, message: Any) -> tuple[Any, ...]:
        """Return the values; raise LookupError where a status is missing."""
        return self.form.values(message.status)

    def read(self, topic: str, message: Any) -> Any:
        """Return the values for a node; raise DdctError for values unfit for the loop."""
        return self.form.read(topic, message.status)


def _level(status: Any) -> int:
    level = status.level
    return level[0] if isinstance(level, bytes) else level


def _pairs(status: Any) -> tuple[tuple[str, str], ...]:
    return tuple([(pair.key, pair.value) for pair in status.values])


@dataclass(frozen=True)
class PairsForm(StatusForm):
    """One status; its value are the (key, value) pairs."""

    names: tuple[str, ...] = ('',)

    def contents(self, pairs: Pairs) -> Sequence[tuple[int, Pairs]]:
        """Return these pairs of the one status."""
        return ((OK, pairs),)

    def values(self, statuses: Sequence[Any]) -> tuple[tuple[tuple[str, str], ...]]:
        """Return the pairs."""
        return (_pairs(statuses[0]),)

    def read(self, topic: str, statuses: Sequence[Any]) -> tuple[str, dict[str, str]]:
        """Return the name of the status, and the pairs; raise DdctError without a status."""
        if not statuses:
            raise DdctError(f'{topic} has no status: it needs one, with pairs', key=topic)
        return statuses[0].name, dict(_pairs(statuses[0]))


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

    def contents(self, *values: Any) -> Sequence[tuple[int, Pairs]]:
        """Return the level of each status for flags."""
        flags: list[float] = []
        for names, value in zip(self.samples, values, strict=True):
            flags.extend(value if len(names) > 1 else (value,))
        return [(STALE if flag else OK, ()) for flag in flags]

    def values(self, statuses: Sequence[Any]) -> tuple[Any, ...]:
        """Return the flags; raise LookupError where a status is missing."""
        flags = {status.name: float(_level(status) == STALE) for status in statuses}
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

    def contents(self, phase: float, *works_and_events: Any) -> Sequence[tuple[int, Pairs]]:
        """Return the pairs for the number of a phase, works in J, and events."""
        *works, events = works_and_events
        pairs = [('phase', PHASES[int(phase)])]
        pairs += [(key, repr(float(work))) for key, work in zip(self.works, works, strict=True)]
        for event in events:
            pairs.append((event.kind, repr(event.time_s)))
            if event.slip_acceleration is not None:
                pairs.append((_ACCELERATION, repr(event.slip_acceleration)))
        return ((OK, pairs),)

    def values(self, statuses: Sequence[Any]) -> tuple[Any, ...]:
        """Return phase number, works in J and events; raise LookupError for bad ones."""
        pairs = _pairs(statuses[0])
        try:
            (_, phase), *rest = pairs
            works = {key: float(value) for key, value in rest[: len(_WORKS)] if key in _WORKS}
            events = _events(rest[len(works) :])
            return float(PHASES.index(phase)), *(works[key] for key in self.works), events
        except (ValueError, KeyError):
            raise LookupError(f'its status holds {pairs}') from None

    def read(self, topic: str, statuses: Sequence[Any]) -> float:
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
