# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write rosbag2 bags, one MCAP file and its `metadata.yaml` each, reproducible to the byte."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from mcap.writer import Writer

from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.bag_file.metadata import (
    ADVICE,
    RECORD_NAME,
    SERIALIZATION,
    bag_information,
    channel_metadata,
    metadata_record,
    write_metadata,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.signals.topic import Topic

_CHUNK_BYTES = 64 * 1024
"""Size of an MCAP chunk in bytes, about 0.2 s of a run; a killed recorder loses its last chunk."""


def bag_file(folder: Path, name: str) -> Path:
    """Return the path of the MCAP file of the bag `name` in `folder`."""
    return folder / f'{name}_0.mcap'


class BagWriter:
    """
    Writer of a bag: an MCAP file and, once closed, the `metadata.yaml` beside it.

    The same messages in the same order give the same bytes: times are the given stamps. After an
    error the file stays unfinished: readers take what is whole. As a context manager it closes
    the bag, or leaves it unfinished when an exception passes.
    """

    def __init__(
        self, folder: Path, name: str, topics: Sequence[Topic], custom_data: Mapping[str, str]
    ) -> None:
        """
        Create the file `<folder>/<name>_0.mcap` for topics of the graph.

        Raise DdctError where that fails or the file already exists.
        """
        self.path = bag_file(folder, name)
        self._custom_data = dict(custom_data)
        self._counts = dict.fromkeys(topics, 0)
        self._topics = {
            name: topic for topic in topics for name in (topic.name, topic.resolved_name)
        }
        self._first_ns = self._last_ns = 0
        self._schemas: dict[str, int] = {}
        channels = [(topic, channel_metadata(topic)) for topic in topics]
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._file = self.path.open('xb')
        except FileExistsError as error:
            raise DdctError(
                'already there: choose another output folder, or delete it', place=self.path
            ) from error
        except OSError as error:
            raise self._cannot_write(error) from error
        self._writer = Writer(self._file, chunk_size=_CHUNK_BYTES, enable_data_crcs=True)
        try:
            # The default is the library's name and version, with which the bytes would change.
            self._writer.start('ros2', 'ddct_bringup')
            self._ids = {topic: self._register(topic, metadata) for topic, metadata in channels}
            self._add_metadata()
            self._file.flush()
        except OSError as error:
            raise self._gave_up(error) from error

    def write(self, topic: str, stamp_ns: int, cdr: bytes) -> None:
        """
        Append a serialised message, stamped `stamp_ns` in the bag.

        The topic may lack its leading slash. Raise DdctError for a topic the bag does not have and
        for a write that fails.
        """
        known = self._topics.get(topic)
        if known is None:
            raise DdctError(f'the bag was opened without a topic {topic}', place=self.path)
        self.write_tick(stamp_ns, [known], [cdr])

    def write_tick(self, stamp_ns: int, topics: Sequence[Topic], cdrs: Sequence[bytes]) -> None:
        """
        Append a serialised message of each of some topics of the bag, all stamped `stamp_ns`.

        Raise DdctError for a write that fails.
        """
        if self._file.closed:
            raise DdctError(f'{self.path}: the recording is already closed')
        self._first_ns = min(self._first_ns or stamp_ns, stamp_ns)
        self._last_ns = max(self._last_ns, stamp_ns)
        try:
            for topic, cdr in zip(topics, cdrs, strict=True):
                self._counts[topic] += 1
                self._writer.add_message(self._ids[topic], stamp_ns, cdr, stamp_ns)
            self._file.flush()  # finished chunks survive a killed process
        except OSError as error:
            raise self._gave_up(error) from error

    def close(self) -> None:
        """Write the summary and `metadata.yaml`, once; do nothing after a failed write."""
        if self._file.closed:
            return
        try:
            information = self._add_metadata()
            self._writer.finish()
            self._file.close()
        except OSError as error:
            raise self._gave_up(error) from error
        write_metadata(self.path.parent, information)

    def __enter__(self) -> 'BagWriter':
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        """Close the bag, or leave it unfinished after an exception."""
        if kind is None:
            self.close()
        else:
            self._abandon()

    def _register(self, topic: Topic, metadata: dict[str, str]) -> int:
        # rosbag2 gives each type one schema, however many topics have it.
        schema = self._schemas.get(topic.type)
        if schema is None:
            text = load_definition(topic.type).schema_text
            schema = self._writer.register_schema(topic.type, 'ros2msg', text.encode())
            self._schemas[topic.type] = schema
        return self._writer.register_channel(topic.resolved_name, SERIALIZATION, schema, metadata)

    def _add_metadata(self) -> dict[str, Any]:
        information = bag_information(
            self.path.name, self._counts, self._first_ns, self._last_ns, self._custom_data
        )
        self._writer.add_metadata(RECORD_NAME, metadata_record(information))
        return information

    def _abandon(self) -> None:
        with suppress(OSError):  # closing tries to write the rest once more
            self._file.close()

    def _gave_up(self, error: OSError) -> DdctError:
        """Leave the file unfinished, and return the error to raise."""
        self._abandon()
        return self._cannot_write(error)

    def _cannot_write(self, error: OSError) -> DdctError:
        return DdctError(f'{self.path}: cannot write the recording ({error.strerror}): {ADVICE}')
