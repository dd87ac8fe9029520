# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Serve serialised ROS messages to Foxglove over WebSocket, on the simulated time axis."""

from collections.abc import Callable
from typing import Any

from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.bag_file.metadata import SERIALIZATION
from ddct_plant.base.errors import DdctError, printable
from ddct_plant.signals.topics import TOPICS

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

    def __init__(self, host: str, port: int, on_view: Callable[[str], None]) -> None:
        """Serve on a port of `host`, 0 for a free one; raise DdctError where it cannot."""
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
            for topic in TOPICS
        }
        try:
            self._server = foxglove.start_server(
                name='DDCT',
                host=host,
                port=port,
                capabilities=[foxglove.websocket.Capability.Time],
                server_listener=self,
                context=self._context,
                message_backlog_size=_BACKLOG,
            )
        except (RuntimeError, OverflowError) as error:
            reason = str(error).removeprefix('FoxgloveError: ')
            raise DdctError(
                f'cannot serve on port {port} of {printable(host)} ({reason}): '
                'choose another --port or --host, or stop the program that has it'
            ) from error
        self.url = f'ws://{f"[{host}]" if ":" in host else host}:{self._server.port}'

    def send(self, topic: str, stamp_ns: int, cdr: bytes) -> None:
        """Send one message to every viewer that shows its topic, without waiting."""
        self._channels[topic].log(cdr, log_time=stamp_ns)

    def set_time(self, stamp_ns: int) -> None:
        """Send the simulated time to every viewer; going back makes them start afresh."""
        self._server.broadcast_time(stamp_ns)

    def stop(self) -> None:
        """Close every connection."""
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
