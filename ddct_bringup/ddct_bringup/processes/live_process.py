# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Live view of one run: program `live` in a process of its own."""

import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

from ddct_bringup.processes.fork_server import start_processes
from ddct_bringup.processes.forked import Forked
from ddct_bringup.processes.graph_names import GraphNames
from ddct_bringup.processes.supervisor import POLL_S
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.domain import own_domain
from ddct_plant.program.command_line import ROS_ARGUMENTS

VIEWER_SUBSCRIBED = 'a viewer shows'
"""Start of the line that `live` prints when a viewer subscribes to a topic."""
ALL_TOPICS_RECEIVED = 'every topic of a tick has come'
"""Line that `live` prints when it has received every topic of a tick."""

RECEIVE_S = 10.0
"""Longest wait, s, of a run with its nodes at t_0 until `live` receives them; then it goes on."""
_STOP_S = 10.0


class LiveView(Forked):
    """Running program `live`; its printed lines show its progress."""

    def wait_for_viewer(self) -> None:
        """Wait without a limit until a viewer shows a topic; raise DdctError when `live` ends."""
        self._wait_for('ws://')
        url = self.printed_text().split('ws://')[1].split()[0]
        text = f'open ws://{url} in Foxglove: the run begins when a panel shows a topic'
        print(text, file=sys.stderr, flush=True)
        self._wait_for(VIEWER_SUBSCRIBED)

    def receives(self) -> bool:
        """Return whether it has received every topic of t_0; raise DdctError when `live` ended."""
        self._require_running()
        return ALL_TOPICS_RECEIVED in self.printed_text()

    def stop(self) -> None:
        """End the process."""
        self.send(signal.SIGINT)
        if not self.wait(_STOP_S):
            self.send(signal.SIGKILL)
            self.wait(_STOP_S)
        self.close()

    def _wait_for(self, text: str) -> None:
        """Wait until it has printed a text; raise DdctError when it ends before."""
        while text not in self.printed_text():
            self._require_running()
            time.sleep(POLL_S)

    def _require_running(self) -> None:
        if not self.running:
            *_, last = ['it ended without a word', *self.lines()]
            raise DdctError(last.strip().removeprefix('ddct live: '))


@contextmanager
def live_view(port: int, names: GraphNames) -> Iterator[LiveView]:
    """
    Reserve a domain for one run, serve it on a port, and yield once a viewer shows a topic.

    `names` are those of its graph.

    Port 0 takes a free one. A run is over in seconds: it waits for its viewer. Raise DdctError if
    it cannot be served.
    """
    with own_domain():
        given = ['--port', str(port), ROS_ARGUMENTS, *names.remaps()]
        view = LiveView('ddct_bringup.programs.live', *given)
        try:
            start_processes([view.process])
            view.begin()
            view.wait_for_viewer()
            yield view
        finally:
            view.stop()
