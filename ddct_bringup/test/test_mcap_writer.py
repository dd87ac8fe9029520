"""Our MCAP writer gives the bytes of the MCAP library's."""

import io

import pytest
from mcap.writer import CompressionType, Writer

from ddct_bringup.bag.mcap_writer import McapWriter

CHUNK_BYTES = 4096


def library_file(messages):
    """Return the file that the library writes of (channel, time, data)."""
    stream = io.BytesIO()
    writer = Writer(
        stream,
        chunk_size=CHUNK_BYTES,
        compression=CompressionType.ZSTD,
        enable_data_crcs=True,
    )
    writer.start(profile='ros2', library='test')
    first = writer.register_schema('a/msg/A', 'ros2msg', b'float64 a')
    second = writer.register_schema('b/msg/B', 'ros2msg', b'string b')
    for topic, schema in (('/one', first), ('/two', second), ('/three', second)):
        writer.register_channel(topic, 'cdr', schema, {'qos': topic})
    writer.add_metadata('begin', {'key': 'value'})
    for channel, time, data in messages:
        writer.add_message(channel, time, data, time)
    writer.add_metadata('end', {'count': str(len(messages))})
    writer.finish()
    return stream.getvalue()


def our_file(messages):
    """Return the file that our writer makes of the same."""
    stream = io.BytesIO()
    writer = McapWriter(stream, 'ros2', 'test', CHUNK_BYTES)
    first = writer.add_schema('a/msg/A', 'ros2msg', b'float64 a')
    second = writer.add_schema('b/msg/B', 'ros2msg', b'string b')
    for topic, schema in (('/one', first), ('/two', second), ('/three', second)):
        writer.add_channel(topic, 'cdr', schema, {'qos': topic})
    writer.add_metadata('begin', {'key': 'value'})
    for channel, time, data in messages:
        writer.add_message(channel, time, data)
    writer.add_metadata('end', {'count': str(len(messages))})
    writer.finish()
    return stream.getvalue()


IN_ORDER = [(1 + k % 3, 10**9 + k, bytes([k % 251]) * (k % 90)) for k in range(500)]
OUT_OF_ORDER = [(3 - k % 2, 10**9 + 7 * k % 500, bytes([k % 251]) * 50) for k in range(500)]
ONE_CHANNEL_LATE = [*IN_ORDER[::3], *IN_ORDER[1::3]]


@pytest.mark.parametrize(
    'messages',
    [
        [],
        IN_ORDER[:1],
        IN_ORDER[:10],
        IN_ORDER,
        OUT_OF_ORDER,
        ONE_CHANNEL_LATE,
        [(1, 2**40, b'x' * CHUNK_BYTES), (2, 2**63, b'')],
    ],
    ids=['none', 'one', 'one chunk', 'chunks', 'out of order', 'late channel', 'large'],
)
def test_file_is_the_one_that_the_library_writes(messages):
    assert our_file(messages) == library_file(messages)


def test_statistics_count_what_is_not_yet_in_a_chunk():
    writer = McapWriter(io.BytesIO(), 'ros2', 'test', CHUNK_BYTES)
    schema = writer.add_schema('a/msg/A', 'ros2msg', b'float64 a')
    channels = [writer.add_channel(topic, 'cdr', schema, {}) for topic in ('/one', '/two')]
    for k in range(101):
        writer.add_message(channels[k % 2], 1000 - k, bytes(80))
    statistics = writer.statistics()
    assert statistics.channel_message_counts == {channels[0]: 51, channels[1]: 50}
    assert (statistics.message_start_time, statistics.message_end_time) == (900, 1000)
    assert statistics.chunk_count > 1
