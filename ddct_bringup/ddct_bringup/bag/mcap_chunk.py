"""Pack MCAP messages into a chunk, much faster than by an `mcap.records.Message` for each."""

import struct
import zlib

import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Chunk, ChunkIndex, McapRecord

_MESSAGE = struct.Struct('<BQHIQQ')
"""Opcode, length of what follows, channel, sequence number, log time, publish time; then data."""
_MESSAGE_OPCODE = int(Opcode.MESSAGE)
_MESSAGE_FIELDS = _MESSAGE.size - struct.calcsize('<BQ')
_INDEX = struct.Struct('<BQHI')
"""Opcode, length of what follows, channel, length of the entries; then a time and a place each."""
_INDEX_FIELDS = _INDEX.size - struct.calcsize('<BQ')
_COMPRESSION = 'zstd'


class McapChunk:
    """The chunk that is being filled."""

    def __init__(self) -> None:
        self._content = bytearray()
        self._entries: dict[int, list[int]] = {}

    def add_record(self, record: McapRecord) -> None:
        """Add a schema or a channel."""
        self._content += record_bytes(record)

    def add_message(self, channel: int, time_ns: int, data: bytes) -> int:
        """Add a message of the channel with this number and return how long the chunk is now."""
        content = self._content
        self._entries.setdefault(channel, []).extend((time_ns, len(content)))
        length = _MESSAGE_FIELDS + len(data)
        content += _MESSAGE.pack(_MESSAGE_OPCODE, length, channel, 0, time_ns, time_ns)
        content += data
        return len(content)

    def counts(self) -> dict[int, int]:
        """Return the number of messages by channel, in the order of their first messages."""
        return {channel: len(entries) // 2 for channel, entries in self._entries.items()}

    def times_ns(self) -> tuple[int, int]:
        """Return the first and the last time; only for a chunk with messages."""
        times = [time for entries in self._entries.values() for time in entries[::2]]
        return min(times), max(times)

    def pack(
        self, start: int, compressor: zstandard.ZstdCompressor
    ) -> tuple[bytes, bytes, ChunkIndex]:
        """Return the chunk to be written at place `start`, what follows it, and its summary."""
        content = bytes(self._content)
        compressed = compressor.compress(content)
        first_ns, last_ns = self.times_ns()
        checksum = zlib.crc32(content)
        chunk = record_bytes(
            Chunk(_COMPRESSION, compressed, last_ns, first_ns, checksum, len(content))
        )
        offsets, indexes = {}, b''
        for channel, entries in self._entries.items():
            offsets[channel] = start + len(chunk) + len(indexes)
            indexes += _message_index(channel, entries)
        summary = ChunkIndex(
            chunk_length=len(chunk),
            chunk_start_offset=start,
            compression=_COMPRESSION,
            compressed_size=len(compressed),
            message_end_time=last_ns,
            message_index_length=len(indexes),
            message_index_offsets=offsets,
            message_start_time=first_ns,
            uncompressed_size=len(content),
        )
        return chunk, indexes, summary


def record_bytes(*records: McapRecord) -> bytes:
    """Return records as they stand in a file."""
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    return builder.end()


def _message_index(channel: int, entries: list[int]) -> bytes:
    """Return the record of when and where a channel's messages are, from both in turn."""
    length = 8 * len(entries)
    start = _INDEX.pack(Opcode.MESSAGE_INDEX, _INDEX_FIELDS + length, channel, length)
    return start + struct.pack(f'<{len(entries)}Q', *entries)
