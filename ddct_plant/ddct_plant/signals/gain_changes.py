# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Gains of a controller that were changed in a run, as `controller/status` carries them."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

from ddct_plant.base.errors import DdctError, require_number
from ddct_plant.base.timebase import stamp_of_step, step_of_stamp, time_of_step

Pair = tuple[str, str]
"""Key and value of a status."""
_KEY = 'changed gains.'
_VALUE = re.compile(r'(\S+) to (\S+) at (\d{1,18}) ns')


class GainChange(NamedTuple):
    """A gain that a controller has from a step on in place of an earlier one."""

    gain: str
    """Name of the gain."""
    before: float
    after: float
    step: int
    """Step k of the first request that is computed with it."""

    @property
    def time_s(self) -> float:
        """Scenario time of that step in s."""
        return time_of_step(self.step)

    @property
    def text(self) -> str:
        """The change in words."""
        return f'{self.gain} {self.before:.6g} to {self.after:.6g} at {self.time_s:g} s'

    @property
    def pair(self) -> Pair:
        """Pair of the status; its numbers have the digits that give the same bits again."""
        stamp_ns = stamp_of_step(self.step)
        return f'{_KEY}{self.gain}', f'{self.before!r} to {self.after!r} at {stamp_ns} ns'

    @classmethod
    def of(cls, pair: Pair) -> 'GainChange':
        """Return the change in a pair of a status; raise DdctError for another text."""
        key, value = pair
        try:
            found = _VALUE.fullmatch(value)
            *gains, stamp = found.groups() if found else ('', '', '')
            before, after = (require_number(key, float(each)) for each in gains)
            return cls(key.removeprefix(_KEY), before, after, step_of_stamp(int(stamp)))
        except (ValueError, DdctError) as error:
            raise DdctError(
                f'controller/status has {key!r} {value!r}: give OLD to NEW at STAMP ns', key=key
            ) from error


class GainRecord:
    """The latest change of each gain of one controller in a run."""

    def __init__(self) -> None:
        """Start without a change."""
        self._before: dict[str, float] = {}
        self._latest: dict[str, GainChange] = {}
        self.pairs: tuple[Pair, ...] = ()
        """A pair for each gain that was changed, also if it has its first value again."""

    def announce(self, names: Iterable[str], gains: Mapping[str, float]) -> None:
        """Keep what these gains are now: they may be others at the next step."""
        for name in names:
            self._before.setdefault(name, float(gains[name]))

    def update(self, gains: Callable[[], Mapping[str, float]], step: int) -> None:
        """Record the announced gains with which step k is computed, where they differ."""
        if not self._before:
            return
        for name, before in self._before.items():
            after = float(gains()[name])
            if after != before:
                self._latest[name] = GainChange(name, before, after, step)
        self._before.clear()
        self.pairs = tuple(each.pair for each in self._latest.values())


def gain_changes(statuses: Sequence[Iterable[Pair]]) -> tuple[GainChange, ...]:
    """
    Return all changes of gains in a run, in order, from its statuses at each step.

    A status carries the latest change of each gain; a message that is lost takes none with it.
    Raise DdctError for a pair of a change that cannot be read.
    """
    if not any(key.startswith(_KEY) for key, _ in statuses[-1]):
        return ()
    pairs = dict.fromkeys(
        pair for status in statuses for pair in status if pair[0].startswith(_KEY)
    )
    return tuple(sorted(map(GainChange.of, pairs), key=lambda each: each.step))


def changes_note(changes: Iterable[GainChange]) -> str:
    """Return one line on the gains that were changed in a run; empty for none."""
    texts = ', '.join(each.text for each in changes)
    return f'gains changed in the run: {texts}' if texts else ''
