# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Work in a process of its own, forked from this one: compiled code of a third party runs in it.

Such code may crash, loop without end, or end its process, and its static variables start afresh in
each process. The result comes back whole or not at all.
"""

import ctypes
import faulthandler
import gc
import itertools
import mmap
import os
import pickle
import select
import signal
import struct
from collections.abc import Callable
from contextlib import suppress
from typing import NoReturn, TypeVar

from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError
from ddct_plant.program.signals import obey_parent

_MOST_SECONDS = 10.0
"""Longest time in s from one call of foreign code to the next; then the process is killed."""
_POLL_S = 0.25
"""Time in s between two looks at the process. Only these count: while this one is stopped, so may
the other be."""
_CALL = struct.Struct('q16sq')
"""Struct of the last call of foreign code: its number, its name, and the step or -1."""
NOTE_BYTES = _CALL.size
"""Size of a note of calls, bytes."""
_DONE = NOTE_BYTES
"""Offset of the byte that is 1 once the result is complete."""
_numbers = itertools.count(1)
_note: mmap.mmap | None = None
"""Memory with the last call of foreign code, which another process has too; None without one."""
_own = False
"""Whether this is a process that `in_own_process` has made."""
_kept: list[tuple[object, Callable[[], object]]] = []
"""Objects that stay until the result is complete, each with the function that ends it then."""
Result = TypeVar('Result')


class ProcessEndedError(DdctError):
    """The process ended without a result: the text says how, and in which call."""


def note_calls(memory: mmap.mmap) -> None:
    """Note each call of foreign code in `memory`, of `NOTE_BYTES` or more, from now on."""
    global _note
    _note = memory


def calling(name: str, step: int = -1) -> None:
    """Note the call of a function of foreign code, for the reason if its process ends in it."""
    if _note is not None:
        _CALL.pack_into(_note, 0, next(_numbers), name.encode(), step)


def last_call(note: bytes) -> str:
    """Return ' when update was called at step 7' of a note of calls; '' without a call."""
    number, name, step = _CALL.unpack_from(note)
    at_step = f' at step {step}' if step >= 0 else ''
    return f' when {name.rstrip(bytes(1)).decode()} was called{at_step}' if number else ''


def keep(resource: object, end: Callable[[], object]) -> None:
    """In a process of its own, keep an object until the result is complete; `end` may crash."""
    if _own:
        _kept.append((resource, end))


def end_at_exit() -> None:
    """
    Let exit() in C end this process at once, with what C has printed and its exit code.

    Else the libraries of the program clean up: they may wait for threads that a fork does not
    have, or crash beside those that still run.
    """
    libc = ctypes.CDLL(None)
    # The handlers run in the reverse order.
    libc.on_exit(libc._exit, None)
    libc.__cxa_atexit(libc.fflush, None, None)


def in_own_process(work: Callable[[], Result]) -> Result:
    """
    Return `work()`, computed in a fork of this process; what it prints goes to standard error.

    Raise the exception of `work`, or ProcessEndedError when the process crashes, ends itself, or
    makes no call within `_MOST_SECONDS` after the last one. Result and exception are pickled.
    """
    if _own:
        return work()  # this is such a process
    result = os.memfd_create('result')
    try:
        with mmap.mmap(-1, _DONE + 1) as shared:
            ctypes.CDLL(None).fflush(None)  # what C has printed here, a fork would print again
            parent = os.getpid()
            process = os.fork()
            if not process:
                _compute(work, shared, result, parent)
            code = _wait(process, shared)
            if not shared[_DONE]:
                raise ProcessEndedError(_reason(code, shared))
        with os.fdopen(os.dup(result), 'rb') as file:
            file.seek(0)
            done, value = pickle.load(file)
    finally:
        os.close(result)
    if not done:
        raise value
    return value


def _wait(process: int, shared: mmap.mmap) -> int | None:
    """Return the exit code of the process when it has ended; None if it was killed as too slow."""
    descriptor = os.pidfd_open(process)
    poller = select.poll()
    poller.register(descriptor, select.POLLIN)
    last, unchanged_s = b'', 0.0
    try:
        while not poller.poll(1e3 * _POLL_S):
            unchanged_s = unchanged_s + _POLL_S if shared[:] == last else 0.0
            last = shared[:]
            if unchanged_s >= _MOST_SECONDS:
                _kill(process)
                return None
        return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    except BaseException:  # such as Ctrl-C
        with suppress(ChildProcessError):
            _kill(process)
        raise
    finally:
        os.close(descriptor)


def _kill(process: int) -> None:
    os.kill(process, signal.SIGKILL)
    os.waitpid(process, 0)


def _reason(code: int | None, shared: mmap.mmap) -> str:
    """Return how the process has ended, and in which call."""
    if code is None:
        how = f'it gave no answer within {_MOST_SECONDS:g} s'
    elif code < 0:
        names = {each.value: each.name for each in signal.Signals}
        how = f'it crashed ({names.get(-code, f"signal {-code}")})'
    else:
        how = f'it ended with exit code {code}'
    return f'{how}{last_call(shared[:]) or " when it was loaded"}'


def _compute(work: Callable[[], object], shared: mmap.mmap, result: int, parent: int) -> NoReturn:
    """Be the new process: write the result of `work`, or its exception, and end."""
    global _own
    code = 1
    try:
        obey_parent(parent)
        faulthandler.disable()  # a crash becomes the reason of a run, in one line
        with suppress(OSError):
            os.dup2(2, 1)  # what the code prints is no result of the program
            os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        end_at_exit()
        gc.freeze()  # collecting what the program has made would copy it
        _own = True
        note_calls(shared)
        with os.fdopen(result, 'wb') as file:
            file.write(_outcome(work))
        shared[_DONE] = 1
        for _, end in _kept:
            end()
        code = 0
    finally:
        # As at the end of a program in C: what it has printed is written.
        ctypes.CDLL(None).fflush(None)
        os._exit(code)


def _outcome(work: Callable[[], object]) -> bytes:
    """Return the pickled pair of whether `work` returned, and its value or exception."""
    outcome: tuple[bool, object]
    try:
        outcome = True, work()
    except FOREIGN_FAILURES as error:
        # Where Dask is loaded, tblib pickles these too, and they may refer to foreign code.
        error.__cause__ = error.__context__ = None
        outcome = False, error.with_traceback(None)
    try:
        pickled = pickle.dumps(outcome)
        if not outcome[0]:
            pickle.loads(pickled)  # an exception may need more than its text
    except Exception as error:
        failure = error if outcome[0] else outcome[1]
        return pickle.dumps((False, DdctError(f'{type(failure).__name__}: {failure}')))
    return pickled
