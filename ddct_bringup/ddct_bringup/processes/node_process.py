"""A program as our child process, and a node as one: what it prints, whether it still runs."""

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
"""How long a node may take to start before it counts as hung."""
LEAVE_S = 2.0
"""How long a node whose work is over may take to leave the graph before it is ended."""
MOST_ELAPSED_S = 1.0
"""Time between two looks counts up to this: when we were stopped, nobody's silence shows."""
_ENDED_BY = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
"""What we send."""
_PIPE_BYTES = 1 << 16
"""All that a pipe holds (Linux), so that a farewell is read whole."""


class Child:
    """A program of ours, which does not outlive us, and what it prints; `WarmParent` starts it."""

    process: ForkedProcess

    def __init__(self, module: str, *arguments: str, pulse: int | None = None) -> None:
        """Prepare to run `main` of a module with these arguments."""
        # In memory: a full disk must not swallow the reason of a failure.
        self._printed = os.memfd_create(module)
        self.job = Job(module, arguments, output=self._printed, pulse=pulse)

    @property
    def running(self) -> bool:
        """Whether it has not ended."""
        return self.process.poll() is None

    def printed(self) -> bytes:
        """Return what it has printed so far."""
        # Not by seek and read: the process writes at the file position that we share with it.
        return os.pread(self._printed, os.fstat(self._printed).st_size, 0)

    def words(self) -> str:
        """Return the same as text."""
        return self.printed().decode(errors='replace')

    def last_words(self) -> str:
        """Return the last line of it, empty for none."""
        lines = self.words().strip().splitlines()
        return lines[-1].strip() if lines else ''

    def close(self) -> None:
        """Forget what it has printed."""
        os.close(self._printed)


class NodeProcess(Child):
    """A running node."""

    def __init__(self, spec: NodeSpec, parameter_file: Path, log: Path) -> None:
        """Give it its parameters; `tidy` writes what it prints into `log`."""
        self.name = spec.name
        self.log = log
        self.hung = False
        """Whether it had to be killed because it did not stop when asked."""
        self._limit_s = START_S
        self._silent_s = 0.0
        self._farewell: int | None = None
        self._segments: set[str] = set()
        self._pulse, pulse = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        parameters = ('--ros-args', '--params-file', str(parameter_file))
        super().__init__(spec.module, *parameters, pulse=pulse)
        self._its_pulse: int | None = pulse

    @property
    def code(self) -> int | None:
        """Its exit code, None before it has ended; of one that hung while leaving what it said."""
        code = self.process.poll()
        by_us = code is not None and -code in _ENDED_BY
        return self._farewell if by_us and self._farewell is not None else code

    def look(self, elapsed_s: float) -> None:
        """
        Note its pulse and its shared memory, `elapsed_s` after the last look.

        End it if its work is over and it has hung since then.
        """
        self._segments |= segments_of(self.process.pid)
        self._silent_s += min(elapsed_s, MOST_ELAPSED_S)
        with contextlib.suppress(BlockingIOError):
            if said := os.read(self._pulse, _PIPE_BYTES):
                self._silent_s, self._limit_s = 0.0, ANSWER_TIMEOUT_S
                _, last, code = said.partition(EXIT_MARK)
                self._farewell = int(code) if last else None
        if self._farewell is not None and self._silent_s > LEAVE_S:
            self.process.kill()

    def silence(self) -> str:
        """Say in one line that it shows no sign of life for too long, '' while it does."""
        if self._silent_s <= self._limit_s:
            return ''
        return f'node {self.name} has shown no sign of life for {self._limit_s:g} s'

    def send(self, number: signal.Signals) -> None:
        """Ask a node that has not ended to stop, waking it if need be; SIGKILL says it hung."""
        if self.running:
            self.look(0.0)
            self.hung = number == signal.SIGKILL
            self.process.send_signal(number)
            self.process.send_signal(signal.SIGCONT)

    def tidy(self) -> None:
        """Keep the log of a node that has ended, and remove what it could not remove itself."""
        with contextlib.suppress(OSError):
            self.log.write_bytes(self.printed())
        if self.process.returncode is not None and self.process.returncode < 0:
            remove_segments(self._segments)

    def close(self) -> None:
        """Forget what it has printed, and its pulse."""
        super().close()
        os.close(self._pulse)
        self.close_its_pulse()

    def close_its_pulse(self) -> None:
        """Close the end of the pipe that the node has by now."""
        if self._its_pulse is not None:
            os.close(self._its_pulse)
            self._its_pulse = None

    def obituary(self) -> str:
        """Say in one line how the node ended."""
        code = self.code
        if self.hung or code is None:
            return f'node {self.name} did not stop when asked and was killed'
        if code < 0:
            return f'node {self.name} was killed by {signal.Signals(-code).name}'
        words = self.last_words().removeprefix(f'{self.name}: ')
        return f'node {self.name} ended with code {code}{f": {words}" if words else ""}'
