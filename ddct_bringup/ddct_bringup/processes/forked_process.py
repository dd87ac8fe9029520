# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Process forked by the warm parent, a child of this process."""

import os
import select
import signal
import subprocess


class ForkedProcess:
    """Child process with the methods of `subprocess.Popen` that the supervisor uses."""

    def __init__(self, pid: int, name: str) -> None:
        """Wrap the child with this process id; `name` is its name in a TimeoutExpired."""
        self.pid = pid
        self.returncode: int | None = None
        """Exit code, -n after signal n; None until `poll` or `wait` has returned it."""
        self._name = name

    def poll(self) -> int | None:
        """Return the exit code, None while the process runs."""
        return self._take(os.WNOHANG)

    def wait(self, timeout: float | None = None) -> int:
        """Wait for the end and return the exit code; raise TimeoutExpired after `timeout` in s."""
        if timeout is not None and self.poll() is None:
            descriptor = os.pidfd_open(self.pid)
            try:
                ended, _, _ = select.select([descriptor], [], [], timeout)
            finally:
                os.close(descriptor)
            if not ended:
                raise subprocess.TimeoutExpired(self._name, timeout)
        code = self._take(0)
        assert code is not None
        return code

    def send_signal(self, number: signal.Signals) -> None:
        """Send a signal to the process unless it has ended."""
        # Its process id is not reused before this process has waited for it.
        if self.poll() is None:
            os.kill(self.pid, number)

    def kill(self) -> None:
        """Kill the process."""
        self.send_signal(signal.SIGKILL)

    def _take(self, options: int) -> int | None:
        if self.returncode is None:
            try:
                pid, status = os.waitpid(self.pid, options)
            except ChildProcessError:  # where SIGCHLD is ignored the kernel waits for it
                self.returncode = 0
            else:
                if pid:
                    self.returncode = os.waitstatus_to_exitcode(status)
        return self.returncode
