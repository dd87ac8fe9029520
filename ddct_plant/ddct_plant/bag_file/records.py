# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Read the records of a bag's MCAP file, strictly or as far as it is readable.

The messages are unpacked chunk by chunk, so that only one chunk of them is in memory.
"""

import contextlib
import io
import struct
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import StreamReader
from zstandard import ZstdError

from ddct_plant.bag_file.facts import require_duration
from ddct_plant.bag_file.metadata import RECORD_NAME, information_of
from ddct_plant.bag_file.record_scan import UsedRecord, in_chunk, used_records
from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import located, read_file

MAGIC = b'\x89MCAP0\r\n'
"""First and last bytes of an MCAP file."""
MOST_BYTES = 1_000_000_000
"""Largest size of a bag's file in bytes; an hour's run has a quarter of that."""

StoredMessage = tuple[str, int, bytes]
"""Topic of a message, its log time in ns and its serialised bytes."""

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


@dataclass
class BagRecords:
    """Records of an MCAP file that readers use; messages are still serialised."""

    path: Path
    data: bytes = field(repr=False)
    """Content of the file."""
    strict: bool = True
    """Whether damage is an error; else reading ends there."""
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
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

    def messages(self) -> Iterator[StoredMessage]:
        """
        Yield the messages in the order of the file.

        Raise DdctError at damage if `strict`.
        """
        with self._damage_named():
            for batch in self._batches():
                yield from batch

    def batches(self) -> Iterator[list[StoredMessage]]:
        """Yield the messages of each chunk, in the order of the file; raise as `messages`."""
        with self._damage_named():
            for batch in self._batches():
                yield list(batch)

    def _batches(self) -> Iterator[Iterator[StoredMessage]]:
        end = len(self.data) - len(MAGIC) if self.data.endswith(MAGIC) else len(self.data)
        for record in used_records(self.data, len(MAGIC), end):
            if isinstance(record, Chunk):
                yield self._messages_of(in_chunk(record))
            elif isinstance(record, Message):
                yield self._messages_of([record])

    def _messages_of(self, records: Iterable[UsedRecord]) -> Iterator[StoredMessage]:
        for each in records:
            if isinstance(each, Message):
                yield self.channels[each.channel_id].topic, each.log_time, each.data
            else:
                self._add(each)

    def survey(self) -> None:
        """
        Add all records but those in chunks, after a check of the file's checksums.

        Those in chunks are added too if there is no channel elsewhere. Raise DdctError at damage
        if `strict`, and for a duration that no run has or that the scenario contradicts.
        """
        with self._damage_named():
            # The library verifies the checksum of the data, and reads also what is not used here.
            for record in StreamReader(
                io.BytesIO(self.data),
                emit_chunks=True,
                validate_crcs=self.strict,
                record_size_limit=len(self.data),
            ).records:
                if not isinstance(record, Chunk):
                    self._add(record)
        with located(str(self.path)):
            require_duration(self.custom_data)
        if not self.channels:
            for _ in self.messages():
                pass

    def _add(self, record: McapRecord) -> None:
        """Add a record; a repeated schema or channel does not replace the first one."""
        if isinstance(record, Schema):
            self.schemas.setdefault(record.id, record)
        elif isinstance(record, Channel):
            self.channels.setdefault(record.id, record)
        elif isinstance(record, Metadata) and record.name == RECORD_NAME:
            self.information = information_of(record.metadata) or self.information

    @contextlib.contextmanager
    def _damage_named(self) -> Iterator[None]:
        """Raise DdctError for damage, or end there if not `strict`."""
        try:
            yield
        except _READ_ERRORS as error:
            if self.strict:
                raise _damaged(self.path, error) from error


def read_records(path: Path) -> BagRecords:
    """
    Read a complete MCAP file; its messages are yielded by `messages`, verified too.

    Raise DdctError when the file cannot be read, is no MCAP file, is unfinished or is damaged.
    """
    data = _bytes_of(path)
    if not data.endswith(MAGIC) or len(data) == len(MAGIC):
        raise DdctError(
            'the recording is unfinished, its writer was interrupted or the file cut '
            'short: rescue what it holds with ddct score --repair',
            place=path,
        )
    try:
        _verify_summary(data)
    except _READ_ERRORS as error:
        raise _damaged(path, error) from error
    bag = BagRecords(path, data)
    bag.survey()
    return bag


def salvage_records(path: Path) -> BagRecords:
    """
    Read an MCAP file up to the first damage.

    Raise DdctError when the file cannot be read or is no MCAP file.
    """
    bag = BagRecords(path, _bytes_of(path), strict=False)
    bag.survey()
    return bag


def _damaged(path: Path, error: BaseException) -> DdctError:
    what = ' '.join(str(error).split()) or type(error).__name__
    return DdctError(
        f'the recording is damaged ({what}): rescue what is readable with ddct score --repair',
        place=path,
    )


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
    if opcode != Opcode.FOOTER or (checksum and zlib.crc32(covered) != checksum):
        raise ValueError('the checksum of the summary is wrong')
