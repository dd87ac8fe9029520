"""A process that the warm parent has forked and that has become our child."""

import os
import select
import signal
import subprocess


class ForkedProcess:
    """A child of ours, to be used like a `subprocess.Popen`."""

    def __init__(self, pid: int, name: str) -> None:
        """Take the child with this id; `name` stands in a complaint that it takes too long."""
        self.pid = pid
        self.returncode: int | None = None
        """Its exit code, -n after signal n; None until `poll` or `wait` has seen its end."""
        self._name = name

    def poll(self) -> int | None:
        """Return its exit code, None while it runs."""
        return self._take(os.WNOHANG)

    def wait(self, timeout: float | None = None) -> int:
        """Return its exit code once it has ended; raise TimeoutExpired after a time in s."""
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
        """Send it a signal unless it has ended."""
        # Nobody else gets its number before we have waited for it.
        if self.poll() is None:
            os.kill(self.pid, number)

    def kill(self) -> None:
        """Kill it."""
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
