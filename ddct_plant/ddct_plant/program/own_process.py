# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Work in a process of its own, on Linux a fork of this one: code of a third party runs in it.

Such code may crash, loop without end, or end its process, and its static variables start afresh in
each process. The result comes back whole or not at all.
"""

import faulthandler
import gc
import itertools
import os
import pickle
import signal
import struct
from collections.abc import Callable
from contextlib import suppress
from multiprocessing import connection
from typing import Any, NoReturn, TypeVar

from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError
from ddct_plant.program.operating_system import (
    Sent,
    end_at_exit,
    flush_c_output,
    main_left_out,
    process_context,
)
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
_numbers = itertools.count(1)
_note: Any = None
"""Memory with the last call of foreign code, which another process has too; None without one."""
_own = False
"""Whether this is a process that `in_own_process` has made."""
_kept: list[tuple[object, Callable[[], object]]] = []
"""Objects that stay until the result is complete, each with the function that ends it then."""
Result = TypeVar('Result')


class ProcessEndedError(DdctError):
    """The process ended without a result: the text says how, and in which call."""


def note_calls(memory: Any) -> None:
    """Note each call of foreign code in a writable buffer of `NOTE_BYTES` from now on."""
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


def in_own_process(work: Callable[[], Result]) -> Result:
    """
    Return `work()`, computed by another process; what it prints goes to standard error.

    Raise the exception of `work`, or ProcessEndedError when the process crashes, ends itself, or
    makes no call within `_MOST_SECONDS` after the last one. Result and exception are pickled.
    """
    if _own:
        return work()  # this is such a process
    context = process_context()
    shared = context.RawArray('c', NOTE_BYTES)
    reader, writer = context.Pipe(duplex=False)
    process = context.Process(target=_compute, args=(Sent(work), writer, shared, os.getpid()))
    flush_c_output()  # what C has printed here, a fork would print again
    with reader:
        with writer, main_left_out():
            process.start()
        try:
            pickled, in_time = _wait(process, reader, shared)
        finally:  # such as Ctrl-C
            process.kill()
            process.join()
    if pickled is None:
        raise ProcessEndedError(_reason(process.exitcode if in_time else None, shared[:]))
    done, value = pickle.loads(pickled)
    if not done:
        raise value
    return value


def _wait(process: Any, reader: Any, shared: Any) -> tuple[bytes | None, bool]:
    """
    Wait until the process has ended, or has made no call for too long.

    Return its outcome, None without a whole one, and whether it has ended.
    """
    waited, outcome = [reader, process.sentinel], None
    last, unchanged_s = b'', 0.0
    while unchanged_s < _MOST_SECONDS:
        # A process that it has started itself may keep the sentinel.
        running = process.is_alive()
        ready = connection.wait(waited, _POLL_S if running else 0.0)
        if reader in ready:
            waited.remove(reader)
            with suppress(EOFError, OSError):
                outcome = reader.recv_bytes()
        elif ready or not running:
            return outcome, True
        else:
            unchanged_s = unchanged_s + _POLL_S if shared[:] == last else 0.0
            last = shared[:]
    return outcome, False


def _reason(code: int | None, note: bytes) -> str:
    """Return how the process has ended, and in which call."""
    if code is None:
        how = f'it gave no answer within {_MOST_SECONDS:g} s'
    elif code < 0:
        names = {each.value: each.name for each in signal.Signals}
        how = f'it crashed ({names.get(-code, f"signal {-code}")})'
    else:
        how = f'it ended with exit code {code}'
    return f'{how}{last_call(note) or " when it was loaded"}'


def _compute(work: Sent, writer: Any, shared: Any, parent: int) -> NoReturn:
    """Be the new process: send the result of `work`, or its exception, and end."""
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
        writer.send_bytes(_outcome(work.value))
        for _, end in _kept:
            end()
        code = 0
    finally:
        # As at the end of a program in C: what it has printed is written.
        flush_c_output()
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
