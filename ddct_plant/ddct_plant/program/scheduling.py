# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
How the kernel treats a process of a real-time run: SCHED_FIFO, locked memory, cores (Linux).

Everything is off by default, because it needs a permission or takes time from other programs.
"""

import ctypes
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Thread

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import OptionGroup, option

MOST_PRIORITY = 98
"""Largest priority that may be asked for: the one above is that of the kernel's own threads."""
_MCL_CURRENT, _MCL_FUTURE = 1, 2


@dataclass(frozen=True)
class Scheduling(OptionGroup):
    """Scheduling of the processes of a real-time run; the default is that of any program."""

    realtime_priority: int = option(
        0,
        'Real time: priority of a node under SCHED_FIFO, before all usual programs; 0 is none',
        at_least=0,
        at_most=MOST_PRIORITY,
    )
    lock_memory: bool = option(False, 'Real time: keep all memory of a node in RAM')
    cpus: str = option('', 'Real time: cores on which a node may run, such as 0,2-3; empty is all')

    def __post_init__(self) -> None:
        """Raise ParameterError for values out of range, and for a list of no cores."""
        super().__post_init__()
        if self.cpus:
            cpus_in(self.cpus)

    @property
    def chosen(self) -> dict[str, object]:
        """Values by name that differ from the defaults."""
        values = {name: each.default for name, each in self.options.items()}
        return {
            name: value for name, value in values.items() if value != getattr(Scheduling, name)
        }

    def require_mode(self, *, lockstep: bool) -> None:
        """Raise ParameterError where anything is asked for in lock-step."""
        for name in self.chosen if lockstep else ():
            raise ParameterError(
                f'{name} is for real time, and the run is in lock-step, which waits for every '
                'node: choose the mode realtime, or leave it out',
                key=name,
            )

    def require_permitted(self) -> None:
        """Raise ParameterError where `apply` is not permitted here; change nothing that lasts."""
        if self.realtime_priority:
            _in_a_thread(lambda: _set_priority(0, self.realtime_priority))
        if self.lock_memory:
            _lock(_MCL_CURRENT)
            _libc().munlockall()
        if self.cpus:
            _in_a_thread(lambda: _set_cpus(0, self.cpus))

    def apply(self) -> None:
        """
        Give this process, all its threads and later ones, what is asked for.

        Raise ParameterError where that is not permitted.
        """
        for thread in _threads():
            # A thread may end meanwhile.
            with suppress(ProcessLookupError):
                if self.realtime_priority:
                    _set_priority(thread, self.realtime_priority)
                if self.cpus:
                    _set_cpus(thread, self.cpus)
        if self.lock_memory:
            _lock(_MCL_CURRENT | _MCL_FUTURE)


@contextmanager
def scheduling_restored() -> Iterator[None]:
    """Take back at the end what `Scheduling.apply` has given to this process."""
    policy, parameters = os.sched_getscheduler(0), os.sched_getparam(0)
    cpus = os.sched_getaffinity(0)
    try:
        yield
    finally:
        changed = os.sched_getscheduler(0) != policy
        for thread in _threads():
            with suppress(ProcessLookupError):
                if changed:
                    os.sched_setscheduler(thread, policy, parameters)
                os.sched_setaffinity(thread, cpus)
        _libc().munlockall()


def cpus_in(text: str) -> set[int]:
    """Return the numbers in a list of cores such as '0,2-3'; raise ParameterError for another."""
    found: set[int] = set()
    for part in text.split(','):
        first, dash, last = part.strip().partition('-')
        ends = (first, last if dash else first)
        if not all(end.isdecimal() and len(end) < 5 for end in ends) or int(ends[0]) > int(
            ends[1]
        ):
            raise ParameterError(f'cpus is {text!r}: give cores such as 0,2-3', key='cpus')
        found |= set(range(int(ends[0]), int(ends[1]) + 1))
    return found


def _threads() -> list[int]:
    return [int(thread.name) for thread in Path('/proc/self/task').iterdir()]


def _set_priority(thread: int, priority: int) -> None:
    try:
        os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(priority))
    except PermissionError as error:
        raise ParameterError(
            f'realtime_priority is {priority}, but this user may not use SCHED_FIFO: set rtprio '
            'in /etc/security/limits.conf and log in again, or leave it out',
            key='realtime_priority',
        ) from error


def _set_cpus(thread: int, text: str) -> None:
    asked, there = cpus_in(text), os.cpu_count() or 1
    try:
        # The kernel takes those that exist, and refuses a list without any.
        if max(asked) >= there:
            raise ValueError
        os.sched_setaffinity(thread, asked)
    except (OSError, ValueError) as error:
        if isinstance(error, ProcessLookupError):
            raise
        raise ParameterError(
            f'cpus is {text!r}, but this process may run on {there} cores, from 0 on, at most: '
            'name some of them, or leave it out',
            key='cpus',
        ) from error


def _lock(flags: int) -> None:
    if _libc().mlockall(flags):
        raise ParameterError(
            f'lock_memory: the memory cannot be locked ({os.strerror(ctypes.get_errno())}): set '
            'memlock to unlimited in /etc/security/limits.conf and log in again, or leave it out',
            key='lock_memory',
        )


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)


def _in_a_thread(trial: Callable[[], None]) -> None:
    """Try in a thread, which alone is changed; raise its ParameterError here."""
    errors: list[ParameterError] = []

    def run() -> None:
        try:
            trial()
        except ParameterError as error:
            errors.append(error)

    thread = Thread(target=run)
    thread.start()
    thread.join()
    if errors:
        raise errors[0]
