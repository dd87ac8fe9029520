"""The live view of one run: program `live` as a process of its own."""

import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ddct_bringup.processes.node_process import Child
from ddct_bringup.processes.node_processes import POLL_S
from ddct_bringup.processes.warm_parent import WarmParent
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.domain import own_domain

DEFAULT_PORT = 8765
"""Where Foxglove looks for a server unless it is told another port."""
VIEWER_CAME = 'a viewer shows'
"""How `live` begins the line that says so."""
HEARS_ALL = 'every topic of a tick has come'
"""What `live` says when it has heard each node of the graph."""

_HEAR_S = 10.0
"""How long a run waits, with its nodes at t_0, until `live` hears them; then it goes on."""
_STOP_S = 10.0


class LiveView(Child):
    """A running `live`; what it prints tells how far it is."""

    def wait_for_viewer(self) -> None:
        """Wait, however long, until a viewer shows a topic; raise DdctError when none can."""
        while 'ws://' not in self.words():
            self._wait()
        url = self.words().split('ws://')[1].split()[0]
        text = f'open ws://{url} in Foxglove: the run begins when a panel shows a topic'
        print(text, file=sys.stderr, flush=True)
        while VIEWER_CAME not in self.words():
            self._wait()

    def wait_until_heard(self, stopped: Callable[[], bool]) -> None:
        """Wait a while for each topic of t_0 to arrive; raise KeyboardInterrupt if `stopped()`."""
        deadline = time.monotonic() + _HEAR_S
        while HEARS_ALL not in self.words() and time.monotonic() < deadline:
            if stopped():
                raise KeyboardInterrupt
            self._wait()

    def stop(self) -> None:
        """End the process."""
        self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(_STOP_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.close()

    def _wait(self) -> None:
        if not self.running:
            words = self.last_words() or 'it ended without a word'
            raise DdctError(words.removeprefix('ddct live: '))
        time.sleep(POLL_S)


@contextmanager
def live_view(port: int, parent: WarmParent) -> Iterator[LiveView]:
    """
    Reserve a domain for one run, serve it on a port, and yield once a viewer shows a topic.

    Port 0 takes a free one. A run is over in seconds: it waits for its viewer. Raise DdctError if
    it cannot be served.
    """
    with own_domain():
        view = LiveView('ddct_bringup.programs.live', '--port', str(port))
        (view.process,) = parent.start([view.job])
        try:
            view.wait_for_viewer()
            yield view
        finally:
            view.stop()
