# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write rosbag2 bags, one MCAP file and its `metadata.yaml` each, reproducible to the byte."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from mcap.writer import Writer

from ddct_plant.bag_file.cdr import CdrNormaliser
from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.bag_file.metadata import (
    ADVICE,
    HASH_KEY,
    QOS_KEY,
    RECORD_NAME,
    SERIALIZATION,
    Channel,
    bag_information,
    metadata_record,
    offered_qos,
    write_metadata,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.signals.topic import Topic

_CHUNK_BYTES = 64 * 1024
"""Size of an MCAP chunk in bytes, about 0.2 s of a run; a killed recorder loses its last chunk."""


def bag_file(folder: Path, name: str) -> Path:
    """Return the path of the MCAP file of the bag `name` in `folder`."""
    return folder / f'{name}_0.mcap'


def new_bag(
    folder: Path, name: str, topics: Sequence[Topic], custom_data: Mapping[str, str]
) -> 'BagWriter':
    """
    Return a writer of the new bag `<folder>/<name>_0.mcap` with topics of the graph.

    Raise DdctError where it cannot be created or already exists.
    """
    channels = []
    for topic in topics:
        definition = load_definition(topic.type)
        channels.append(
            Channel(
                topic.resolved_name,
                definition.type_name,
                definition.schema_text,
                definition.type_hash,
                offered_qos(latched=topic.latched),
                CdrNormaliser(definition).normalise,
            )
        )
    return BagWriter(bag_file(folder, name), channels, custom_data)


class BagWriter:
    """
    Writer of a bag: an MCAP file and, once closed, the `metadata.yaml` beside it.

    The same messages in the same order give the same bytes: times are the given stamps, and bytes
    that carry no value are set to zero. After an error the file stays unfinished: readers refuse
    it, repair can rescue it. As a context manager it closes the bag, or leaves it unfinished when
    an exception passes.
    """

    def __init__(
        self, path: Path, channels: Sequence[Channel], custom_data: Mapping[str, str]
    ) -> None:
        """Create the file; raise DdctError where that fails or the file already exists."""
        self.path = path
        self._channels = tuple(channels)
        self._custom_data = dict(custom_data)
        index = {channel.topic: place for place, channel in enumerate(channels)}
        self._index = {topic.removeprefix('/'): index[topic] for topic in index} | index
        self._counts = [0] * len(channels)
        self._first_ns = self._last_ns = 0
        self._schemas: dict[str, int] = {}
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open('xb')
        except FileExistsError as error:
            raise DdctError(
                'already there: choose another output folder, or delete it', place=path
            ) from error
        except OSError as error:
            raise self._cannot_write(error) from error
        self._writer = Writer(self._file, chunk_size=_CHUNK_BYTES, enable_data_crcs=True)
        try:
            # The default is the library's name and version, with which the bytes would change.
            self._writer.start('ros2', 'ddct_bringup')
            self._ids = [self._register(channel) for channel in channels]
            self._add_metadata()
            self._file.flush()
        except OSError as error:
            raise self._gave_up(error) from error

    def write(self, topic: str, stamp_ns: int, cdr: bytes) -> None:
        """
        Append a serialised message, stamped `stamp_ns` in the bag.

        The topic may lack its leading slash. Raise DdctError for a topic the bag does not have, a
        message that is not of its type, and a write that fails.
        """
        try:
            index = self._index[topic]
        except KeyError:
            raise DdctError(
                f'the bag was opened without a topic {topic}', place=self.path
            ) from None
        try:
            data = self._channels[index].normalise(cdr)
        except DdctError as error:
            raise DdctError(f'{topic} at stamp {stamp_ns} ns: {error}', key=topic) from error
        if self._file.closed:
            raise DdctError(f'{self.path}: the recording is already closed')
        self._first_ns = min(self._first_ns or stamp_ns, stamp_ns)
        self._last_ns = max(self._last_ns, stamp_ns)
        self._counts[index] += 1
        try:
            self._writer.add_message(self._ids[index], stamp_ns, data, stamp_ns)
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

    def _register(self, channel: Channel) -> int:
        # rosbag2 gives each type one schema, however many topics have it.
        schema = self._schemas.get(channel.type_name)
        if schema is None:
            schema = self._schemas[channel.type_name] = self._writer.register_schema(
                channel.type_name, 'ros2msg', channel.schema_text.encode()
            )
        metadata = {QOS_KEY: channel.qos, HASH_KEY: channel.type_hash}
        return self._writer.register_channel(channel.topic, SERIALIZATION, schema, metadata)

    def _add_metadata(self) -> dict[str, Any]:
        information = bag_information(
            self.path.name,
            self._channels,
            self._counts,
            self._first_ns,
            self._last_ns,
            self._custom_data,
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
