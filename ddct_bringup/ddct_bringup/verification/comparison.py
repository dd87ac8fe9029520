# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Compare numbers and texts of a result with those of its repetition: to the last bit, or to a bound.

The bound is for another kind of processor or other versions, where the last bits may differ.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.catalogue import JERK_OVER_LEAST
from ddct_bringup.verification.deviation import deviation_of, deviations_of
from ddct_bringup.verification.states import BOUND, DIFFERENT, SAME_BITS, SAME_WITHIN
from ddct_plant.files.input_file import located, user_text
from ddct_plant.files.json_records import json_text, parse_json

OF_PROGRAM = (JERK_OVER_LEAST.key, 1e-6)
"""Figure that a convex program gives, and its own bound: solvers end at about 1e-9."""
Place = Mapping[str, Any]
"""Place of a value, such as its signal and step, or its key."""


@dataclass(frozen=True)
class Difference:
    """One value that differs."""

    place: Place
    recorded: Any = None
    repeated: Any = None

    def entry(self) -> Mapping[str, Any]:
        """Return the difference as JSON."""
        values = {'recorded': self.recorded, 'repeated': self.repeated}
        return {**self.place, **{key: _plain(each) for key, each in values.items()}}


@dataclass
class Comparison:
    """Comparison of one result with its repetition; differences are added in their order."""

    bits: Difference | None = None
    """First difference at all."""
    beyond: Difference | None = None
    """First difference beyond the bound."""
    largest: float = 0.0
    """Largest difference, relative as BOUND; infinite for values that are no numbers."""

    def add(self, place: Place, recorded: Any, repeated: Any, bound: float = BOUND) -> None:
        """Compare two values: numbers, texts, or None."""
        deviation = deviation_of(recorded, repeated)
        if deviation is not None:
            difference = Difference(place, recorded, repeated)
            figure, own = OF_PROGRAM
            if any(str(each).endswith(figure) for each in place.values()):
                bound = max(bound, own)
            self._note(deviation, difference, bound)

    def add_nested(self, key: str, recorded: Any, repeated: Any, bound: float = BOUND) -> None:
        """
        Compare two values of JSON, whose place is a dotted key.

        The figure OF_PROGRAM, and an entry with its name, have their own bound; `bound` is that of
        the others.
        """
        if isinstance(recorded, Mapping) and isinstance(repeated, Mapping):
            figure, own = OF_PROGRAM
            bound = own if recorded.get('name') == figure else bound
            for name in (*recorded, *(name for name in repeated if name not in recorded)):
                path = f'{key}.{name}' if key else name
                self.add_nested(path, recorded.get(name), repeated.get(name), bound)
        elif isinstance(recorded, list) and isinstance(repeated, list):
            place = {'key': f'{key or "all"}, number of entries'}
            self.add(place, len(recorded), len(repeated), 0.0)
            for number, (ours, theirs) in enumerate(zip(recorded, repeated, strict=False)):
                self.add_nested(f'{key}[{number}]', ours, theirs, bound)
        else:
            self.add({'key': key}, recorded, repeated, bound)

    def add_trajectories(self, recorded: Trajectory, repeated: Trajectory) -> None:
        """Compare all signals of two runs; the first difference is that of the earliest step."""
        ours, theirs = recorded.signals, repeated.signals
        found = [
            each
            for name in (*ours, *(name for name in theirs if name not in ours))
            for each in _signal_differences(name, ours.get(name), theirs.get(name))
        ]
        for deviation, difference in sorted(found, key=lambda each: each[1].place['step']):
            self._note(deviation, difference, BOUND)

    def state(self, *, same_environment: bool) -> str:
        """Return the state: with the same code, versions and processor only equal bits count."""
        if self.bits is None:
            return SAME_BITS
        return DIFFERENT if self.beyond or same_environment else SAME_WITHIN

    def first(self, *, same_environment: bool) -> Difference | None:
        """Return the first difference that makes the state DIFFERENT, None in another state."""
        if self.state(same_environment=same_environment) != DIFFERENT:
            return None
        return self.bits if same_environment else self.beyond

    def _note(self, deviation: float, difference: Difference, bound: float) -> None:
        self.largest = max(self.largest, deviation)
        self.bits = self.bits or difference
        if deviation > bound:
            self.beyond = self.beyond or difference


def _signal_differences(
    name: str, recorded: Any, repeated: Any
) -> Iterator[tuple[float, Difference]]:
    """Yield the first difference of a signal, the first beyond the bound, and the largest one."""
    ours, theirs = _form(recorded), _form(repeated)
    if ours != theirs:
        yield math.inf, Difference({'signal': name, 'step': 0}, ours, theirs)
        return
    steps = min(len(recorded), len(repeated))
    deviations = deviations_of(recorded[:steps], repeated[:steps])
    places = [*np.flatnonzero(deviations >= 0.0)[:1], *np.flatnonzero(deviations > BOUND)[:1]]
    for step in (*places, *([deviations.argmax()] if places else [])):
        values = (recorded[step], repeated[step])
        yield float(deviations[step]), Difference({'signal': name, 'step': int(step)}, *values)
    if len(recorded) != len(repeated):
        yield math.inf, Difference({'signal': name, 'step': steps}, len(recorded), len(repeated))


def _form(signal: Any) -> str:
    """Return the form of a signal: absent, texts, or numbers of a size at each step."""
    if signal is None:
        return 'absent'
    return f'numbers {signal.shape[1:]}' if isinstance(signal, np.ndarray) else 'texts'


def _plain(value: Any) -> Any:
    """Return a value as JSON can contain it."""
    if isinstance(value, np.ndarray):
        return [_plain(each) for each in value.tolist()]
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return repr(value)
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    return [_plain(each) for each in value] if isinstance(value, Sequence) else repr(value)


def plain_json(value: Any) -> Any:
    """Return a value as JSON reads it back: lists for tuples, texts for keys."""
    return parse_json(json_text(value))


def recorded_json(path: Path) -> Any:
    """Return the content of a file of JSON; raise DdctError that names it when that fails."""
    with located(str(path)):
        return parse_json(user_text(path))
