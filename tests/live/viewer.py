# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Viewer such as Foxglove: subscribes to every topic of a server and stores the messages."""

import contextlib
import json
import re
import struct
import threading
from collections import defaultdict
from dataclasses import dataclass, field
from typing import Any

from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory

SUBPROTOCOL = 'foxglove.sdk.v1'
_MESSAGE, _TIME = 1, 2


def address_in(printed: str) -> str:
    """Return the address of the server in a program's output."""
    found = re.search(r'ws://\S+', printed)
    assert found, printed
    return found[0]


@dataclass
class Viewer:
    """Connection that subscribes to everything; as a context manager it ends with the block."""

    url: str
    channels: dict[int, dict[str, Any]] = field(default_factory=dict)
    """Description of each channel from the server, by channel id."""
    messages: dict[str, list[tuple[int, bytes]]] = field(default_factory=lambda: defaultdict(list))
    """Messages as (time in ns, CDR), by topic."""
    times: list[int] = field(default_factory=list)
    """Times of the server's clock in ns, in the order received."""

    def __enter__(self) -> 'Viewer':
        # The tests of errors need no viewer.
        from websockets.sync.client import connect
        from websockets.typing import Subprotocol

        self._opened = contextlib.ExitStack()
        self._socket = self._opened.enter_context(
            connect(self.url, subprotocols=[Subprotocol(SUBPROTOCOL)])
        )
        self._thread = threading.Thread(target=self._read)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._opened.close()
        self._thread.join(10.0)
        assert not self._thread.is_alive()

    def decoded(self, topic: str) -> list[tuple[int, Any]]:
        """Return the messages of a topic, decoded by the schema that the server sent."""
        (channel,) = [each for each in self.channels.values() if each['topic'] == topic]
        assert channel['encoding'] == 'cdr'
        schema = Schema(
            id=1,
            name=channel['schemaName'],
            encoding=channel['schemaEncoding'],
            data=channel['schema'].encode(),
        )
        decode = DecoderFactory().decoder_for('cdr', schema)
        assert decode is not None
        return [(stamp, decode(cdr)) for stamp, cdr in self.messages[topic]]

    def _read(self) -> None:
        from websockets.exceptions import ConnectionClosed

        with contextlib.suppress(ConnectionClosed):
            for frame in self._socket:
                self._take(frame)

    def _take(self, frame: str | bytes) -> None:
        if isinstance(frame, str):
            self._on_text(json.loads(frame))
        elif frame[0] == _MESSAGE:
            number, stamp = struct.unpack_from('<IQ', frame, 1)
            self.messages[self.channels[number]['topic']].append((stamp, frame[13:]))
        elif frame[0] == _TIME:
            self.times.append(struct.unpack_from('<Q', frame, 1)[0])

    def _on_text(self, text: dict[str, Any]) -> None:
        if text['op'] != 'advertise':
            return
        new = {channel['id']: channel for channel in text['channels']}
        self.channels.update(new)
        wanted = [{'id': number, 'channelId': number} for number in new]
        self._socket.send(json.dumps({'op': 'subscribe', 'subscriptions': wanted}))
