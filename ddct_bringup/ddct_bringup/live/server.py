# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Serve serialised ROS messages to Foxglove over WebSocket, on the simulated time axis."""

from collections.abc import Callable
from typing import Any

from ddct_bringup.live.gate import Gate, secret_address
from ddct_bringup.live.handshake import Admission
from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.bag_file.metadata import SERIALIZATION
from ddct_plant.base.errors import DdctError
from ddct_plant.signals.topics import all_topics

_BACKLOG = 65_536
"""
Number of messages queued for a slow viewer, about 40 s of a run; then the oldest are dropped.
"""


class LiveServer:
    """
    Foxglove WebSocket server with one channel per topic of the graph.

    It forwards CDR unchanged, with the schema of the type as in a bag. Its clock is the
    simulated one. `on_view(topic)` is called, in a thread of the server, when a viewer begins
    to show a topic.
    """

    def __init__(
        self,
        admission: Admission,
        port: int,
        on_view: Callable[[str], None],
        print_line: Callable[[str], object],
    ) -> None:
        """
        Start to serve those whom `admission` lets in; refusals are printed.

        Port 0 takes a free one. Raise DdctError where that is impossible.
        """
        foxglove = _foxglove()
        self._on_view = on_view
        # Stored, because its channels close when it is deleted.
        self._context = foxglove.Context()
        self._channels = {
            topic.name: foxglove.Channel(
                topic.resolved_name,
                message_encoding=SERIALIZATION,
                schema=foxglove.Schema(
                    name=topic.type,
                    encoding='ros2msg',
                    data=load_definition(topic.type).schema_text.encode(),
                ),
                context=self._context,
            )
            for topic in all_topics()
        }
        inner = secret_address()
        try:
            self._server = foxglove.start_server(
                name='DDCT',
                host=inner,
                port=0,
                capabilities=[foxglove.websocket.Capability.Time],
                server_listener=self,
                context=self._context,
                message_backlog_size=_BACKLOG,
            )
        except (RuntimeError, OverflowError) as error:
            reason = str(error).removeprefix('FoxgloveError: ')
            raise DdctError(f"Foxglove's server cannot start ({reason}): try again") from error
        try:
            self._gate = Gate(admission, port, (inner, self._server.port), print_line)
        except BaseException:
            self._server.stop()
            raise
        host = admission.host
        self.url = f'ws://{f"[{host}]" if ":" in host else host}:{self._gate.port}'

    def send(self, topic: str, stamp_ns: int, cdr: bytes) -> None:
        """Send one message to every viewer that shows its topic, without waiting."""
        self._channels[topic].log(cdr, log_time=stamp_ns)

    def set_time(self, stamp_ns: int) -> None:
        """Send the simulated time to every viewer; going back makes them start afresh."""
        self._server.broadcast_time(stamp_ns)

    def stop(self) -> None:
        """Close every connection."""
        self._gate.stop()
        self._server.stop()

    def on_subscribe(self, client: Any, channel: Any) -> None:
        """Handle a viewer's subscription to a topic."""
        self._on_view(channel.topic)

    def on_unsubscribe(self, client: Any, channel: Any) -> None:
        """Handle a viewer's end of a subscription; the server requires this method."""


def _foxglove() -> Any:
    try:
        import foxglove.websocket
    except ImportError as error:
        raise DdctError(
            f'the live view needs the package foxglove-sdk ({error}): install it with '
            'python -m pip install foxglove-sdk, in the environment that runs the nodes'
        ) from error
    return foxglove
