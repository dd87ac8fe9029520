"""Write a run's messages into a rosbag2 bag: one MCAP file and its `metadata.yaml`."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType

from ddct_bringup.bag.file.cdr import CdrNormaliser
from ddct_bringup.bag.file.mcap_file import McapFile
from ddct_bringup.bag.file.message_definitions import load_definition
from ddct_bringup.bag.file.metadata import Channel, offered_qos
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.topics import Topic


def bag_file(folder: Path, name: str) -> Path:
    """Return the path of the MCAP file of the bag `name` in `folder`."""
    return folder / f'{name}_0.mcap'


class BagWriter:
    """
    A bag `<folder>/<name>_0.mcap` in the making.

    The same messages in the same order give the same bytes: times are the given stamps, and bytes
    that carry no value are set to zero. As a context manager it closes the bag, or leaves it
    unfinished when an exception passes.
    """

    def __init__(
        self,
        folder: Path,
        name: str,
        topics: Sequence[Topic],
        custom_data: Mapping[str, str],
    ) -> None:
        """Create the bag; raise DdctError where that is impossible or it is already there."""
        definitions = [load_definition(topic.type) for topic in topics]
        channels = [
            Channel(
                topic.resolved_name,
                definition.type_name,
                definition.schema_text,
                definition.type_hash,
                offered_qos(latched=topic.latched),
            )
            for topic, definition in zip(topics, definitions, strict=True)
        ]
        self._topics = {
            name: (index, normaliser)
            for index, topic in enumerate(topics)
            for normaliser in [CdrNormaliser(definitions[index])]
            for name in (topic.name, topic.resolved_name)
        }
        self.path = bag_file(folder, name)
        self._file = McapFile(self.path, channels, custom_data)

    def write(self, topic: str, stamp_ns: int, cdr: bytes) -> None:
        """
        Append a serialised message, stamped `stamp_ns` in the bag.

        Raise DdctError for a topic the bag does not have, a message that is not of its type, and
        a write that fails.
        """
        try:
            index, normaliser = self._topics[topic]
        except KeyError:
            raise DdctError(f'{self.path}: the bag was opened without a topic {topic}') from None
        try:
            data = normaliser.normalise(cdr)
        except DdctError as error:
            raise DdctError(f'{topic} at stamp {stamp_ns} ns: {error}') from error
        self._file.write(index, stamp_ns, data)

    def close(self) -> None:
        """Finish the bag, once; after a failed write leave it unfinished."""
        self._file.finish()

    def __enter__(self) -> 'BagWriter':
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Close the bag, or leave it unfinished after an exception."""
        if error is None:
            self.close()
        else:
            self._file.abandon()
