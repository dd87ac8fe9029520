"""Write one MCAP file as rosbag2 does, so that the same messages give the same bytes."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO, Any, cast

from mcap.writer import Writer

from ddct_bringup.bag.file.metadata import (
    HASH_KEY,
    QOS_KEY,
    RECORD_NAME,
    SERIALIZATION,
    Channel,
    bag_information,
    metadata_record,
    metadata_yaml,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import write_text

METADATA_FILE = 'metadata.yaml'
_ADVICE = 'free some space or choose another output folder'

_CHUNK_BYTES = 64 * 1024
"""About 0.2 s of a run; a killed recorder loses the chunk it was filling."""


class McapFile:
    """
    A new MCAP file and, once finished, the `metadata.yaml` beside it.

    After an error the file stays unfinished: readers refuse it, repairing can rescue it.
    """

    def __init__(
        self, path: Path, channels: Sequence[Channel], custom_data: Mapping[str, str]
    ) -> None:
        """Create the file; raise DdctError where that is impossible or it is already there."""
        self._path = path
        self._channels = tuple(channels)
        self._custom_data = dict(custom_data)
        self._schemas: dict[str, int] = {}
        self._counts = [0] * len(channels)
        self._first_ns = self._last_ns = 0
        self._sink = _Sink(path)
        self._writer = Writer(
            cast(IO[bytes], self._sink), chunk_size=_CHUNK_BYTES, enable_data_crcs=True
        )
        # The library would name itself with its version here, and the bytes change with it.
        self._writer.start('ros2', 'ddct_bringup')
        self._ids = [self._register(channel) for channel in channels]
        self._add_metadata()

    def write(self, channel: int, stamp_ns: int, data: bytes) -> None:
        """Append a message to the channel with this index; raise DdctError when it fails."""
        if self._sink.closed:
            raise DdctError(f'{self._path}: the recording is already closed')
        self._first_ns = min(self._first_ns or stamp_ns, stamp_ns)
        self._last_ns = max(self._last_ns, stamp_ns)
        self._counts[channel] += 1
        self._writer.add_message(self._ids[channel], stamp_ns, data, stamp_ns)

    def finish(self) -> None:
        """Write the summary and `metadata.yaml`, once; do nothing after a failed write."""
        if self._sink.closed:
            return
        information = self._add_metadata()
        self._writer.finish()
        self._sink.close()
        write_metadata(self._path.parent, information)

    def abandon(self) -> None:
        """Leave the file unfinished."""
        self._sink.close()

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
            self._path.name,
            self._channels,
            self._counts,
            self._first_ns,
            self._last_ns,
            self._custom_data,
        )
        self._writer.add_metadata(RECORD_NAME, metadata_record(information))
        return information


def write_metadata(folder: Path, information: Mapping[str, Any]) -> None:
    """Write `metadata.yaml` whole or not at all; raise DdctError when it fails."""
    write_text(str(folder / METADATA_FILE), metadata_yaml(information), _ADVICE)


def _cannot_write(path: Path, error: OSError) -> DdctError:
    return DdctError(f'{path}: cannot write the recording ({error.strerror}): {_ADVICE}')


class _Sink:
    """The file, unbuffered: what a finished chunk holds survives a killed process."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self.closed = False
        self._written = 0
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open('xb', buffering=0)
        except FileExistsError as error:
            raise DdctError(
                f'{path}: already there: choose another output folder, or delete it'
            ) from error
        except OSError as error:
            raise _cannot_write(path, error) from error

    def write(self, data: bytes) -> int:
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[self._file.write(rest) :]
        except OSError as error:
            self.close()
            raise _cannot_write(self._path, error) from error
        self._written += len(data)
        return len(data)

    def tell(self) -> int:
        return self._written

    def close(self) -> None:
        self.closed = True
        self._file.close()
