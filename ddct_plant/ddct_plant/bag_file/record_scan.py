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
from dataclasses import replace

from lz4.frame import LZ4FrameDecompressor
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Message, Metadata, Schema
from mcap.stream_reader import get_chunk_data_stream
from zstandard import frame_content_size

from ddct_plant.bag_file.limits import Allowance

MOST_CHUNK_BYTES = 64_000_000
"""Largest size of an unpacked chunk in bytes; recorders make chunks of about 1 MB."""
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


def used_records(data: bytes, start: int, stop: int, allowance: Allowance) -> Iterator[UsedRecord]:
    """
    Yield the records between two places of the bytes; all of them count in `allowance`.

    Raise struct.error, ValueError or an error of the MCAP library where a record is cut short,
    and ValueError where there are too many.
    """
    end = start
    while end < stop:
        allowance.add_record()
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


def in_chunk(chunk: Chunk, allowance: Allowance) -> Iterator[UsedRecord]:
    """Yield the records in a chunk as `used_records`, after a check of its checksum."""
    if chunk.compression == 'lz4':
        # The library would unpack it to any size.
        lz4 = LZ4FrameDecompressor()
        data = lz4.decompress(chunk.data, max_length=chunk.uncompressed_size)
        if not lz4.eof and lz4.decompress(b'', max_length=1):
            raise ValueError(f'a chunk has more than its {chunk.uncompressed_size} bytes')
        chunk = replace(chunk, compression='', data=data)
    stream, size = get_chunk_data_stream(chunk, validate_crc=True)
    yield from used_records(stream.read(size), 0, size, allowance)


def unpacked_size(chunk: Chunk) -> int:
    """Return the size of an unpacked chunk; raise ValueError where it would fill the memory."""
    size = max(chunk.uncompressed_size, len(chunk.data))
    if chunk.compression == 'zstd':
        size = max(size, frame_content_size(chunk.data))
    if size > MOST_CHUNK_BYTES:
        raise ValueError(f'a chunk has {size} bytes unpacked, more than {MOST_CHUNK_BYTES}')
    return size
