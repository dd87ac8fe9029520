# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Progress of long work on standard error: steps done, their rate and the remaining time."""

import time
from collections.abc import Iterable
from typing import TypeVar

from rich.console import Console
from rich.text import Text

_QUIET_S = 2.0
"""Time in s before the first line; shorter work prints none."""
_EVERY_S = {True: 0.5, False: 10.0}
"""Time in s between two lines, on a terminal (True) and elsewhere."""
Step = TypeVar('Step')


class Progress:
    """Progress line of work that is done in steps; as a context manager it clears the line."""

    def __init__(self, what: str, total: int | None = None, *, done: int = 0) -> None:
        """
        Start the clock; `done` of `total` steps are from before and not in the rate.

        The total is None where nobody knows it before the end.
        """
        # Here, and not for each program that may show progress.
        from rich.live import Live

        self._what = what
        self._total = total
        self._before = done
        self._console = Console(stderr=True, highlight=False)
        # Without a thread of its own: the program may fork.
        self._live = Live(console=self._console, auto_refresh=False, transient=True)
        self._started = time.perf_counter()
        self._next = self._started + _QUIET_S

    def __enter__(self) -> 'Progress':
        return self

    def __exit__(self, *_: object) -> None:
        self._live.stop()

    def update(self, done: int, left_s: float | None = None) -> None:
        """
        Print the line for `done` steps if it is due: steps and their total, rate, remaining time.

        That time follows from the rate, unless `left_s` in s is given, for steps of unequal
        length.
        """
        now = time.perf_counter()
        if now < self._next:
            return
        is_terminal = self._console.is_terminal
        self._next = now + _EVERY_S[is_terminal]
        line = self._line(done, now - self._started, left_s)
        if is_terminal:
            self._live.start()
            self._live.update(Text(line), refresh=True)
        else:
            print(line, file=self._console.file, flush=True)

    def _line(self, done: int, elapsed: float, left_s: float | None) -> str:
        rate = (done - self._before) / elapsed if elapsed else 0.0
        text = f'{self._what}: {done}'
        if self._total is not None:
            text += f' of {self._total}'
        if not rate:
            return text
        text += f', {rate:.3g} a second'
        if self._total is None:
            return text
        left_s = (self._total - done) / rate if left_s is None else left_s
        return f'{text}, {_duration(left_s)} left'


def with_progress(steps: Iterable[Step], total: int, description: str) -> Iterable[Step]:
    """Return the steps; a terminal has a progress bar on standard error while they are taken."""
    console = Console(stderr=True)
    if not console.is_terminal or total < 2:
        return steps
    from rich.progress import track

    return track(steps, description, total, console=console, transient=True)


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f'{hours} h {minutes} min'
    return f'{minutes} min {rest} s' if minutes else f'{rest} s'
