"""The live view of one run: program `live` as a process of its own."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ddct_bringup.processes.node_processes import POLL_S
from ddct_bringup.processes.ros_domain import own_domain
from ddct_plant.base.errors import DdctError
from ddct_plant.program.stop_signals import end_with_parent

DEFAULT_PORT = 8765
"""Where Foxglove looks for a server unless it is told another port."""
VIEWER_CAME = 'a viewer shows'
"""How `live` begins the line that says so."""
HEARS_ALL = 'every topic of a tick has come'
"""What `live` says when it has heard each node of the graph."""

_HEAR_S = 10.0
"""How long a run waits, with its nodes at t_0, until `live` hears them; then it goes on."""
_STOP_S = 10.0


class LiveView:
    """A running `live`; what it prints tells how far it is."""

    def __init__(self, port: int) -> None:
        """Start it on a port, 0 for a free one, in the present ROS domain."""
        self._printed = os.memfd_create('live')
        self._process = subprocess.Popen(
            [sys.executable, '-P', '-m', 'ddct_bringup.programs.live', '--port', str(port)],
            stdin=subprocess.DEVNULL,
            stdout=self._printed,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            preexec_fn=end_with_parent,
        )

    def wait_for_viewer(self) -> None:
        """Wait, however long, until a viewer shows a topic; raise DdctError when none can."""
        while 'ws://' not in self._words():
            self._wait()
        url = self._words().split('ws://')[1].split()[0]
        text = f'open ws://{url} in Foxglove: the run begins when a panel shows a topic'
        print(text, file=sys.stderr, flush=True)
        while VIEWER_CAME not in self._words():
            self._wait()

    def wait_until_heard(self, stopped: Callable[[], bool]) -> None:
        """Wait a while for each topic of t_0 to arrive; raise KeyboardInterrupt if `stopped()`."""
        deadline = time.monotonic() + _HEAR_S
        while HEARS_ALL not in self._words() and time.monotonic() < deadline:
            if stopped():
                raise KeyboardInterrupt
            self._wait()

    def stop(self) -> None:
        """End the process."""
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(_STOP_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._printed)

    def _words(self) -> str:
        # Not by seek and read: the process writes at the file position that we share with it.
        size = os.fstat(self._printed).st_size
        return os.pread(self._printed, size, 0).decode(errors='replace')

    def _wait(self) -> None:
        if self._process.poll() is not None:
            lines = self._words().strip().splitlines() or ['ddct live: it ended without a word']
            raise DdctError(lines[-1].removeprefix('ddct live: '))
        time.sleep(POLL_S)


@contextmanager
def live_view(port: int) -> Iterator[LiveView]:
    """
    Reserve a domain for one run, serve it, and yield once a viewer shows a topic.

    A run is over in seconds: it waits for its viewer. Raise DdctError if it cannot be served.
    """
    with own_domain():
        view = LiveView(port)
        try:
            view.wait_for_viewer()
            yield view
        finally:
            view.stop()
