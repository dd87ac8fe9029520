# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Child process of a program, and that of a node: its output and its pulse."""

import contextlib
import os
import signal
from pathlib import Path

from ddct_bringup.processes.forked_process import ForkedProcess
from ddct_bringup.processes.graph_nodes import ANSWER_TIMEOUT_S, NodeSpec
from ddct_bringup.processes.jobs import Job
from ddct_bringup.processes.shared_memory import remove_segments, segments_of
from ddct_plant.program.supervision import EXIT_MARK

START_S = 60.0
"""Wall time after which a node without a pulse since its start counts as hung, s."""
LEAVE_S = 2.0
"""Wall time for a node to end after it has announced its exit code, s; then it is killed."""
MOST_ELAPSED_S = 1.0
"""Largest time between two checks that counts, s: a stopped supervisor misses no pulse."""
_ENDED_BY = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
"""Signals that the supervisor sends to end a node."""
_PIPE_BYTES = 1 << 16
"""Capacity of a pipe in bytes (Linux), so that an announced exit code is read completely."""


class Child:
    """
    Child process of a program, and its output.

    `WarmParent` starts it; it does not outlive this process.
    """

    process: ForkedProcess

    def __init__(self, module: str, *arguments: str, pulse: int | None = None) -> None:
        """Prepare a job that runs `main` of a module with these arguments."""
        # In memory: the reason of a failure must survive a full disk.
        self._printed = os.memfd_create(module)
        self.job = Job(module, arguments, output=self._printed, pulse=pulse)

    @property
    def running(self) -> bool:
        """Whether the process has not ended."""
        return self.process.poll() is None

    def printed(self) -> bytes:
        """Return the output of the process so far, standard output and error."""
        # Not by seek and read: both processes share the file position at which the child writes.
        return os.pread(self._printed, os.fstat(self._printed).st_size, 0)

    def output_text(self) -> str:
        """Return the output of the process so far, as text."""
        return self.printed().decode(errors='replace')

    def last_line(self) -> str:
        """Return the last line of the output, empty for none."""
        lines = self.output_text().strip().splitlines()
        return lines[-1].strip() if lines else ''

    def close(self) -> None:
        """Close the output of the process."""
        os.close(self._printed)


class NodeProcess(Child):
    """Child process of a node, with its pulse and shared memory."""

    def __init__(self, spec: NodeSpec, parameter_file: Path, log: Path) -> None:
        """Prepare the node with its parameter file; `tidy` writes its output into `log`."""
        self.name = spec.path
        self.log = log
        self.hung = False
        """Whether the node was killed because it did not end after the other signals."""
        self.begun = False
        """Whether a pulse of the node has arrived."""
        self._limit_s = START_S
        self._without_pulse_s = 0.0
        self._announced_code: int | None = None
        self._segments: set[str] = set()
        self._pulse, pulse = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        parameters = ['--ros-args', '--params-file', str(parameter_file)]
        if spec.namespace:
            parameters += ['-r', f'__ns:=/{spec.namespace}']
        super().__init__(spec.module, *parameters, pulse=pulse)
        self._pulse_writer: int | None = pulse

    @property
    def code(self) -> int | None:
        """Exit code, None before the end; the announced one of a node that hung while leaving."""
        code = self.process.poll()
        by_us = code is not None and -code in _ENDED_BY
        return self._announced_code if by_us and self._announced_code is not None else code

    def check(self, elapsed_s: float) -> None:
        """
        Read the pulse and update the shared-memory segments, `elapsed_s` after the last check.

        Kill a node that has announced its exit code and has not ended within `LEAVE_S`.
        """
        self._segments |= segments_of(self.process.pid)
        self._without_pulse_s += min(elapsed_s, MOST_ELAPSED_S)
        with contextlib.suppress(BlockingIOError):
            if pulse := os.read(self._pulse, _PIPE_BYTES):
                self._without_pulse_s, self._limit_s = 0.0, ANSWER_TIMEOUT_S
                self.begun = True
                _, last, code = pulse.partition(EXIT_MARK)
                self._announced_code = int(code) if last else None
        if self._announced_code is not None and self._without_pulse_s > LEAVE_S:
            self.process.kill()

    def hang_summary(self) -> str:
        """Return one line that the pulse has been missing for too long; empty while it has not."""
        return self.silence(self._limit_s)

    def silence(self, longer_than_s: float) -> str:
        """Return one line that the pulse has been missing for longer than that; else empty."""
        if self._without_pulse_s <= longer_than_s:
            return ''
        return f'node {self.name} has shown no sign of life for {longer_than_s:g} s'

    def send(self, number: signal.Signals) -> None:
        """Send a signal, and SIGCONT, to a node that has not ended; SIGKILL marks it as hung."""
        if self.running:
            self.check(0.0)
            self.hung = number == signal.SIGKILL
            self.process.send_signal(number)
            self.process.send_signal(signal.SIGCONT)

    def tidy(self) -> None:
        """Write the log of an ended node, and remove the shared memory that it left."""
        with contextlib.suppress(OSError):
            self.log.write_bytes(self.printed())
        # A killed node leaves its segments, and one that ended with an error may leave its own.
        if self.process.returncode:
            remove_segments(self._segments)

    def close(self) -> None:
        """Close the output and the pulse of the node."""
        super().close()
        os.close(self._pulse)
        self.close_pulse_writer()

    def close_pulse_writer(self) -> None:
        """Close this process's copy of the pulse's write end, which the node has inherited."""
        if self._pulse_writer is not None:
            os.close(self._pulse_writer)
            self._pulse_writer = None

    def exit_summary(self) -> str:
        """Return one line on how the node ended."""
        code = self.code
        if self.hung or code is None:
            return f'node {self.name} did not stop on signals and was killed'
        if code < 0:
            return f'node {self.name} was killed by {signal.Signals(-code).name}'
        program = self.name.rpartition('/')[2]
        words = self.last_line().removeprefix(f'{program}: ')
        return f'node {self.name} ended with code {code}{f": {words}" if words else ""}'
