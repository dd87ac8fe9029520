# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Read the records of a bag's MCAP file, strictly or as far as it is readable."""

import contextlib
import io
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mcap.exceptions import McapError
from mcap.records import Channel, Chunk, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import StreamReader, breakup_chunk
from zstandard import ZstdError, frame_content_size

from ddct_bringup.bag.file.metadata import RECORD_NAME, information_of
from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import read_file

MAGIC = b'\x89MCAP0\r\n'
"""First and last bytes of an MCAP file."""
MOST_BYTES = 1_000_000_000
"""Largest size of a bag's file in bytes; an hour's run has a quarter of that."""
MOST_CHUNK_BYTES = 64_000_000
"""Largest size of an unpacked chunk in bytes; recorders make chunks of about 1 MB."""

_READ_ERRORS = (
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
_FOOTER_OPCODE = 2


@dataclass
class BagRecords:
    """Records of an MCAP file that readers use; messages are still serialised."""

    path: Path
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    messages: list[tuple[str, int, bytes]] = field(default_factory=list)
    """Messages as (topic, log time in ns, data), in the order of the file."""
    information: dict[str, Any] = field(default_factory=dict)
    """Content of the last readable `rosbag2` metadata record."""

    @property
    def topics(self) -> set[str]:
        """Resolved names of the topics that have a channel."""
        return {channel.topic for channel in self.channels.values()}

    @property
    def custom_data(self) -> dict[str, str]:
        """Custom data of the bag: the recorder's description of the run."""
        custom = self.information.get('custom_data')
        if not isinstance(custom, dict):
            return {}
        return {str(key): str(value) for key, value in custom.items()}

    def add(self, records: Iterator[McapRecord]) -> None:
        """Add records; a repeated schema or channel does not replace the first one."""
        for record in records:
            if isinstance(record, Message):
                topic = self.channels[record.channel_id].topic
                self.messages.append((topic, record.log_time, record.data))
            elif isinstance(record, Schema):
                self.schemas.setdefault(record.id, record)
            elif isinstance(record, Channel):
                self.channels.setdefault(record.id, record)
            elif isinstance(record, Metadata) and record.name == RECORD_NAME:
                self.information = information_of(record.metadata) or self.information


def read_records(path: Path) -> BagRecords:
    """
    Read a complete MCAP file and verify every checksum.

    Raise DdctError when the file cannot be read, is no MCAP file, is unfinished or is damaged.
    """
    data = _bytes_of(path)
    if not data.endswith(MAGIC) or len(data) == len(MAGIC):
        raise DdctError(
            'the recording is unfinished, its writer was interrupted or the file cut '
            'short: rescue what it holds with ddct score --repair',
            place=path,
        )
    bag = BagRecords(path)
    try:
        _verify_summary(data)
        bag.add(_unpacked(data, validate_crcs=True))
    except _READ_ERRORS as error:
        what = ' '.join(str(error).split()) or type(error).__name__
        raise DdctError(
            f'the recording is damaged ({what}): rescue what is readable with ddct score --repair',
            place=path,
        ) from error
    return bag


def salvage_records(path: Path) -> BagRecords:
    """
    Read an MCAP file up to the first damage.

    Raise DdctError when the file cannot be read or is no MCAP file.
    """
    data = _bytes_of(path)
    bag = BagRecords(path)
    with contextlib.suppress(*_READ_ERRORS):  # what was read before the damage is kept
        bag.add(_unpacked(data, validate_crcs=False))
    return bag


def _unpacked(data: bytes, *, validate_crcs: bool) -> Iterator[McapRecord]:
    """Yield the records, also those in chunks; the checksums of chunks are always verified."""
    reader = StreamReader(
        io.BytesIO(data),
        emit_chunks=True,
        validate_crcs=validate_crcs,
        record_size_limit=len(data),
    )
    for record in reader.records:
        if isinstance(record, Chunk):
            _require_bounded(record)
            yield from breakup_chunk(record, validate_crc=True)
        else:
            yield record


def _require_bounded(chunk: Chunk) -> None:
    """Raise ValueError for a chunk that would fill the memory when it is unpacked."""
    size = chunk.uncompressed_size
    if chunk.compression == 'zstd':
        size = max(size, frame_content_size(chunk.data))
    if size > MOST_CHUNK_BYTES:
        raise ValueError(f'a chunk has {size} bytes unpacked, more than {MOST_CHUNK_BYTES}')


def _bytes_of(path: Path) -> bytes:
    try:
        data = read_file(path, MOST_BYTES)
    except OSError as error:
        raise DdctError(f'cannot read the bag: {error.strerror}', place=path) from error
    if not data.startswith(MAGIC):
        what = 'the file is empty' if not data else 'not an MCAP file'
        raise DdctError(f'{what}: give a bag that this project recorded', place=path)
    return data


def _verify_summary(data: bytes) -> None:
    """Raise ValueError unless the footer's checksum of the summary is correct or absent."""
    opcode, _, start, _, checksum, _ = _FOOTER.unpack(data[-_FOOTER.size :])
    covered = data[start : -len(MAGIC) - 4]
    if opcode != _FOOTER_OPCODE or (checksum and zlib.crc32(covered) != checksum):
        raise ValueError('the checksum of the summary is wrong')
