# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Read the records of a bag's MCAP file, whole or up to the last chunk that is.

A writer ends a file with a footer. A file that has one must be whole: each byte that matters is
under a checksum of its chunk, of the data or of the summary. A file without one is unfinished.
"""

import io
import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, DataEnd, Message, Metadata, Schema
from mcap.stream_reader import StreamReader, get_chunk_data_stream
from zstandard import ZstdError

from ddct_plant.bag_file.metadata import RECORD_NAME, information_of
from ddct_plant.base.errors import DdctError

MAGIC = b'\x89MCAP0\r\n'
"""First and last bytes of an MCAP file."""

StoredMessage = tuple[str, int, bytes]
"""Topic of a message, its log time in ns and its serialised bytes."""

_ERRORS = (
    McapError,
    ZstdError,
    struct.error,
    ValueError,
    LookupError,
    RuntimeError,
    OverflowError,
    MemoryError,
)
"""Exceptions of the MCAP library for damaged bytes; its checksum errors are ValueErrors."""

_FOOTER = struct.Struct('<BQQQI8s')
"""End of an MCAP file: opcode, length, starts of summary and its offsets, checksum, magic."""
_FOOTER_HEAD = struct.pack('<BQ', Opcode.FOOTER, 20)
_HEAD = struct.Struct('<BQ')
"""Beginning of a record: opcode, and size of its content in bytes."""
_MESSAGE = struct.Struct('<HIQQ')
"""Beginning of a message: channel, sequence number, log time and publish time in ns."""
_IN_CHUNKS: dict[int, Callable[[ReadDataStream], Schema | Channel]] = {
    Opcode.SCHEMA: Schema.read,
    Opcode.CHANNEL: Channel.read,
}


@dataclass
class BagRecords:
    """Records of an MCAP file that readers use; messages are still packed and serialised."""

    path: Path
    unfinished: bool = False
    """Whether the file has no footer, so that it holds the beginning of a run alone."""
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    _metadata: list[Mapping[str, str]] = field(default_factory=list, repr=False)
    """Contents of the `rosbag2` metadata records."""
    _data: list[Chunk | Message] = field(default_factory=list, repr=False)

    @property
    def topics(self) -> set[str]:
        """Resolved names of the topics that have a channel."""
        return {channel.topic for channel in self.channels.values()}

    @cached_property
    def custom_data(self) -> dict[str, str]:
        """Custom data of the bag, the recorder's description of the run, in its last metadata."""
        # Those before the last readable ones are not parsed: that takes longer than all messages.
        readable = filter(None, map(information_of, reversed(self._metadata)))
        custom = next(readable, {}).get('custom_data')
        if not isinstance(custom, dict):
            return {}
        return {str(key): str(value) for key, value in custom.items()}

    def messages(self) -> Iterator[StoredMessage]:
        """Yield the messages in the order of the file; raise DdctError at damage."""
        for record in self._data:
            try:
                found = self._unpacked(record)
            except _ERRORS as error:
                raise _damaged(self.path, error) from error
            yield from found

    def _unpacked(self, record: Chunk | Message) -> list[StoredMessage]:
        """Return the messages in a record; add what else is in it."""
        if isinstance(record, Message):
            return [(self.channels[record.channel_id].topic, record.log_time, record.data)]
        stream, size = get_chunk_data_stream(record, validate_crc=True)
        data, end, found = stream.read(size), 0, []
        # The library takes eight calls for a message, and a run has thousands of them.
        while end < size:
            opcode, length = _HEAD.unpack_from(data, end)
            start, end = end + _HEAD.size, end + _HEAD.size + length
            if opcode == Opcode.MESSAGE:
                channel, _, log_time, _ = _MESSAGE.unpack_from(data, start)
                topic = self.channels[channel].topic
                found.append((topic, log_time, data[start + _MESSAGE.size : end]))
            elif read := _IN_CHUNKS.get(opcode):
                self._add(read(ReadDataStream(io.BytesIO(data[start:end]))))
        return found

    def _add(self, record: object) -> bool:
        """Add a record; return whether it ends the data. The first of two channels counts."""
        if isinstance(record, Schema):
            self.schemas.setdefault(record.id, record)
        elif isinstance(record, Channel):
            self.channels.setdefault(record.id, record)
        elif isinstance(record, Metadata) and record.name == RECORD_NAME:
            self._metadata.append(record.metadata)
        elif isinstance(record, Chunk | Message):
            self._data.append(record)
        return isinstance(record, DataEnd)

    def add_all(self, data: bytes) -> None:
        """Add all records of a whole file; raise an error of `_ERRORS` for a damaged one."""
        _require_summary(data)
        reader = _reader(data, validate_crcs=True)
        if sum([self._add(record) for record in reader.records]) != 1:
            raise ValueError('the end of its data is missing')

    def add_until_damage(self, data: bytes) -> None:
        """Add the records before the first that is cut short or damaged."""
        self.unfinished = True
        try:
            for record in _reader(data, validate_crcs=False).records:
                if isinstance(record, Chunk):
                    self._unpacked(record)
                self._add(record)
        except _ERRORS:
            return


def read_records(path: Path) -> BagRecords:
    """
    Read an MCAP file: one with a footer wholly, another up to the last chunk that is whole.

    Raise DdctError when it cannot be read, is no MCAP file, or has a footer and is damaged, and
    for a duration that no run has.
    """
    data, bag = _bytes_of(path), BagRecords(path)
    if not _has_footer(data):
        bag.add_until_damage(data)
    else:
        try:
            bag.add_all(data)
        except _ERRORS as error:
            raise _damaged(path, error) from error
    return bag


def readable_custom_data(path: Path) -> dict[str, str]:
    """Return the custom data before the first damage of an MCAP file; raise DdctError if none."""
    bag = BagRecords(path)
    bag.add_until_damage(_bytes_of(path))
    return bag.custom_data


def _reader(data: bytes, *, validate_crcs: bool) -> StreamReader:
    return StreamReader(
        io.BytesIO(data),
        emit_chunks=True,
        validate_crcs=validate_crcs,
        record_size_limit=len(data),
    )


def _damaged(path: Path, error: BaseException) -> DdctError:
    what = ' '.join(str(error).split()) or type(error).__name__
    return DdctError(f'the recording is damaged ({what}): take another copy of it', place=path)


def _bytes_of(path: Path) -> bytes:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise DdctError(f'cannot read the bag: {error.strerror}', place=path) from error
    if not data.startswith(MAGIC):
        what = 'the file is empty' if not data else 'not an MCAP file'
        raise DdctError(f'{what}: give a bag that this project recorded', place=path)
    return data


def _has_footer(data: bytes) -> bool:
    """Return whether a file ends with a footer, of which one half may be damaged."""
    end = data[-_FOOTER.size :]
    return len(data) > len(MAGIC) and (end.endswith(MAGIC) or end.startswith(_FOOTER_HEAD))


def _require_summary(data: bytes) -> None:
    """Raise ValueError unless the footer's checksum of the summary is correct or absent."""
    opcode, _, start, _, checksum, magic = _FOOTER.unpack(data[-_FOOTER.size :])
    covered = data[start : -len(MAGIC) - 4]
    if magic != MAGIC or opcode != Opcode.FOOTER:
        raise ValueError('its end is no footer')
    if checksum and zlib.crc32(covered) != checksum:
        raise ValueError('the checksum of the summary is wrong')
