# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Find the records in the bytes of an MCAP file or of an unpacked chunk.

A run has thousands of messages, and as many entries of indexes; the MCAP library reads each of
their numbers by a call of its own. Here a message takes two calls, and an index none.
"""

import io
import struct
from collections.abc import Iterator

from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Message, Metadata, Schema
from mcap.stream_reader import get_chunk_data_stream

UsedRecord = Channel | Chunk | Message | Metadata | Schema
"""Record that readers use."""

_HEAD = struct.Struct('<BQ')
"""Beginning of a record: opcode, and size of its content in bytes."""
_MESSAGE = struct.Struct('<HIQQ')
"""Beginning of a message: channel, sequence number, log time and publish time in ns."""
_KINDS: dict[int, type[Channel] | type[Chunk] | type[Metadata] | type[Schema]] = {
    Opcode.CHANNEL: Channel,
    Opcode.CHUNK: Chunk,
    Opcode.METADATA: Metadata,
    Opcode.SCHEMA: Schema,
}


def used_records(data: bytes, start: int, stop: int) -> Iterator[UsedRecord]:
    """
    Yield the records between two places of the bytes.

    Raise struct.error, ValueError or an error of the MCAP library where a record is cut short.
    """
    end = start
    while end < stop:
        opcode, size = _HEAD.unpack_from(data, end)
        start, end = end + _HEAD.size, end + _HEAD.size + size
        if end > stop:
            raise ValueError(f'a record of {size} bytes runs past the end')
        if opcode == Opcode.MESSAGE:
            yield _message(data[start:end])
        elif kind := _KINDS.get(opcode):
            yield kind.read(ReadDataStream(io.BytesIO(data[start:end])))


def _message(content: bytes) -> Message:
    channel, sequence, log_time, publish_time = _MESSAGE.unpack_from(content)
    return Message(channel, log_time, content[_MESSAGE.size :], publish_time, sequence)


def in_chunk(chunk: Chunk) -> Iterator[UsedRecord]:
    """Yield the records in a chunk as `used_records`, after a check of its checksum."""
    stream, size = get_chunk_data_stream(chunk, validate_crc=True)
    yield from used_records(stream.read(size), 0, size)
