# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A process of the fork server that runs a program: its start, its output, its exit code."""

import atexit
import contextlib
import importlib
import mmap
import multiprocessing
import os
import select
import signal
import sys
import threading
from collections.abc import Mapping, Sequence
from multiprocessing.connection import Connection
from pathlib import Path

from ddct_bringup.processes.fork_server import CONTEXT, remove_socket, server_ends
from ddct_plant.program.own_process import NOTE_BYTES, note_calls
from ddct_plant.program.signals import obey_interrupts
from ddct_plant.program.supervision import Patience, end_after, supervise

_ENDED_BY = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL, signal.SIGALRM)
"""Signals that end a process which hangs after it has announced its exit code."""
_UNKNOWN = 255
"""Exit code in `multiprocessing` of a process whose fork server was killed."""
_CODE_S = 2.0
"""Timeout in s for the exit code of a process that has ended, of the fork server."""
ORPHANED_S = 10.0
"""Wall time in s for a process to end by itself after the end of its program."""
_DEATH_S = 0.2
"""Time in s by which a fork server that is killed may end later than its pipes."""


class Forked:
    """
    Process that runs `main` of a module, as if Python had been started for it.

    `start_processes` starts its `process`. It has the environment that this program has when it is
    made, an empty standard input, and it does not outlive this program.
    """

    def __init__(
        self, module: str, *arguments: str, name: str = '', patience: Patience | None = None
    ) -> None:
        """Prepare it; with `patience` it is a node, which ends itself when it hangs."""
        # In memory: the reason of a failure must survive a full disk.
        self._printed = Connection(os.memfd_create(module), readable=False)
        self._announced, self._theirs = CONTEXT.Pipe(duplex=False)
        self._calls = Connection(os.memfd_create('calls'))
        os.ftruncate(self._calls.fileno(), NOTE_BYTES)
        self._code: int | None = None
        self._announced_code: int | None = None
        self.ended: int | None = None
        """Descriptor of the started process, which becomes readable at its end."""
        pipes = self._printed, self._theirs, self._calls
        job = module, arguments, dict(os.environ), *pipes, patience
        self.process = CONTEXT.Process(target=_run, args=job, name=name or module)

    def begin(self) -> None:
        """Note the started process."""
        self._theirs.close()
        # The library's own sentinel ends with the fork server too.
        with contextlib.suppress(ProcessLookupError):
            self.ended = os.pidfd_open(self.pid)

    @property
    def pid(self) -> int:
        """Process id; 0 before the start."""
        return self.process.pid or 0

    @property
    def running(self) -> bool:
        """Whether the process has not ended."""
        return not self.wait(0.0)

    def wait(self, within_s: float) -> bool:
        """Wait for the end, at most `within_s` in s; return whether it has ended."""
        return self.ended is None or bool(select.select([self.ended], [], [], within_s)[0])

    def code(self) -> int | None:
        """
        Return the exit code, -n after signal n; None while it runs, or where nobody knows it.

        Of a process that hung after it had announced its exit code, return that one. The fork
        server knows the others, or this process where the server was killed and `adopt_orphans`
        applied.
        """
        if self._code is None and not self.running:
            self.process.join(_CODE_S)
            code = self.process.exitcode
            if code == _UNKNOWN and server_ends(_DEATH_S):
                code = self._code_of_orphan()
            self._code = code
            if code is None or -code in _ENDED_BY:
                announced = self.announced_code()
                self._code = self._code if announced is None else announced
        return self._code

    def _code_of_orphan(self) -> int | None:
        """Return the exit code if the process has ended as a child of this one."""
        with contextlib.suppress(ChildProcessError):
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            return os.waitstatus_to_exitcode(status) if pid else None
        return None

    def announced_code(self) -> int | None:
        """Return the exit code that a node has announced after its work; None before."""
        if self._announced_code is None:
            with contextlib.suppress(EOFError, OSError):
                if self._announced.poll():
                    self._announced_code = int(self._announced.recv_bytes())
        return self._announced_code

    def send(self, number: signal.Signals) -> None:
        """Send a signal to the process unless it has ended."""
        if self.ended is not None:
            with contextlib.suppress(ProcessLookupError):
                signal.pidfd_send_signal(self.ended, number)

    def printed(self) -> bytes:
        """Return the output of the process so far, standard output and error."""
        # Not by seek and read: both processes share the file position at which it writes.
        descriptor = self._printed.fileno()
        return os.pread(descriptor, os.fstat(descriptor).st_size, 0)

    def calls(self) -> bytes:
        """Return the note of its calls of foreign code."""
        return os.pread(self._calls.fileno(), NOTE_BYTES, 0)

    def printed_text(self) -> str:
        """Return the output of the process so far, as text."""
        return self.printed().decode(errors='replace')

    def lines(self) -> list[str]:
        """Return the lines of the output so far, without empty ones at both ends."""
        return self.printed_text().strip().splitlines()

    def close(self) -> None:
        """Close what belongs to the process here, after its end or where it was not started."""
        for each in (self._printed, self._announced, self._theirs, self._calls):
            each.close()
        if self.ended is not None:
            os.close(self.ended)
            self.ended = None


def _run(
    module: str,
    arguments: Sequence[str],
    environment: Mapping[str, str],
    printed: Connection,
    announced: Connection,
    calls: Connection,
    patience: Patience | None,
) -> None:
    """Run `main` of a module in this process, which the fork server has forked."""
    for stream in (1, 2):
        os.dup2(printed.fileno(), stream)
    printed.close()
    note_calls(mmap.mmap(calls.fileno(), NOTE_BYTES))
    os.environ.clear()
    os.environ.update(environment)
    sys.argv = [module, *arguments]
    with contextlib.suppress(OSError):
        Path('/proc/self/comm').write_text(module.rpartition('.')[2], encoding='ascii')
    obey_interrupts()
    threading.Thread(target=_end_with_program, daemon=True).start()
    if patience:
        supervise(patience, lambda code: announced.send_bytes(b'%d' % code))
    if 'numpy.random' in sys.modules:  # Python seeds its own generator after each fork
        sys.modules['numpy.random'].seed()
    try:
        sys.exit(importlib.import_module(module).main())
    finally:
        # Before Python 3.13 no process of a fork server calls them.
        atexit._run_exitfuncs()


def _end_with_program() -> None:
    """End this process in order when the program that has started it ends."""
    program = multiprocessing.parent_process()
    assert program is not None
    program.join()
    # The others too: one that is paused cannot do it itself.
    os.kill(0, signal.SIGCONT)
    remove_socket()  # the fork server may have been killed too
    end_after(ORPHANED_S)
