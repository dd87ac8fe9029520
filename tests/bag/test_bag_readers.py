# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Other readers accept the bags: rclpy, and the MCAP library with its ROS 2 decoder."""

from collections import defaultdict
from typing import Any

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from ddct_bringup.bag.reader import mcap_of, read_bag
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import recorded_topics

# Keys that rosbag2's decoder of version 9 requires, in its order.
INFORMATION_KEYS = [
    'version',
    'storage_identifier',
    'duration',
    'starting_time',
    'message_count',
    'topics_with_message_count',
    'compression_format',
    'compression_mode',
    'relative_file_paths',
    'files',
    'custom_data',
    'ros_distro',
]
QOS_KEYS = [
    'history',
    'depth',
    'reliability',
    'durability',
    'deadline',
    'lifespan',
    'liveliness',
    'liveliness_lease_duration',
    'avoid_ros_namespace_conventions',
]


@pytest.fixture
def bag(bags, trajectory):
    return bags.write(trajectory)


def test_rclpy_reads_every_message(bag, trajectory):
    serialization = pytest.importorskip('rclpy.serialization', reason='rclpy reads the messages')
    slips, points, statuses = [], [], []
    known = {topic.resolved_name: topic for topic in recorded_topics(RunKind())}
    with mcap_of(bag).open('rb') as stream:
        for schema, channel, stored in make_reader(stream).iter_messages():
            topic = known[channel.topic]
            assert schema.name == topic.type
            message = serialization.deserialize_message(stored.data, topic.message_class)
            assert stamp_ns(message) == stored.log_time
            if channel.topic == '/clutch/slip':
                slips.append(message.twist.angular.x)
            elif channel.topic == '/clutch/torque':
                points.append([point.effort[0] for point in message.points])
            elif channel.topic == '/controller/status':
                pairs = message.status[0].values
                statuses.append(tuple((pair.key, pair.value) for pair in pairs))
    assert np.array_equal(slips, trajectory.slip_speed)
    assert np.array_equal(points, trajectory.clutch_torque)
    assert tuple(statuses) == trajectory.status


def test_mcap_ros2_decodes_every_message_by_the_schemas_in_the_file(bag, trajectory):
    decoded: defaultdict[str, list[Any]] = defaultdict(list)
    with mcap_of(bag).open('rb') as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for _, channel, _, message in reader.iter_decoded_messages():
            decoded[channel.topic].append(message)
    assert sum(map(len, decoded.values())) == 2 + 15 * (trajectory.steps + 1)
    slips = [message.twist.angular.x for message in decoded['/clutch/slip']]
    assert np.array_equal(slips, trajectory.slip_speed)
    speeds = [message.velocity for message in decoded['/driveline/joint_states']]
    assert np.array_equal(speeds, trajectory.joint_speed)


def test_latched_topics_are_marked_transient_local(bag):
    with mcap_of(bag).open('rb') as stream:
        channels = make_reader(stream).get_summary().channels.values()
    for channel in channels:
        (qos,) = yaml.safe_load(channel.metadata['offered_qos_profiles'])
        latched = channel.topic == '/run_info'
        assert qos['durability'] == ('transient_local' if latched else 'volatile')
        assert qos['depth'] == (1 if latched else 10)
        assert qos['reliability'] == 'reliable'


def test_the_index_leads_to_every_message_with_simulated_time(bag, trajectory):
    with mcap_of(bag).open('rb') as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        summary = reader.get_summary()
        assert reader.get_header().profile == 'ros2'
        assert len(summary.chunk_indexes) >= 2
        assert summary.statistics.message_count == 2 + 15 * (trajectory.steps + 1)
        assert {schema.encoding for schema in summary.schemas.values()} == {'ros2msg'}
        decoded = list(reader.iter_decoded_messages())
    assert len(decoded) == summary.statistics.message_count
    assert decoded[0].message.log_time == 1_000_000_000
    assert all(entry.message.log_time == entry.message.publish_time for entry in decoded)


def test_chunks_are_compressed_and_far_below_1_mib(bag):
    with mcap_of(bag).open('rb') as stream:
        chunks = make_reader(stream).get_summary().chunk_indexes
    assert {chunk.compression for chunk in chunks} == {'zstd'}
    assert max(chunk.uncompressed_size for chunk in chunks) < 128 * 1024


def test_metadata_has_the_keys_that_rosbag2_requires(bag, trajectory):
    information = yaml.safe_load((bag / 'metadata.yaml').read_text())[
        'rosbag2_bagfile_information'
    ]
    assert list(information) == INFORMATION_KEYS
    assert information['version'] == 9
    assert information['relative_file_paths'] == [mcap_of(bag).name]
    assert information['starting_time'] == {'nanoseconds_since_epoch': 1_000_000_000}
    assert information['duration'] == {'nanoseconds': trajectory.steps * 10_000_000}
    topics = information['topics_with_message_count']
    assert [topic['topic_metadata']['name'] for topic in topics] == [
        topic.resolved_name for topic in recorded_topics(RunKind())
    ]
    assert sum(topic['message_count'] for topic in topics) == information['message_count']
    for topic in topics:
        metadata = topic['topic_metadata']
        assert metadata['serialization_format'] == 'cdr'
        assert metadata['type_description_hash'].startswith('RIHS01_')
        assert [list(qos) for qos in metadata['offered_qos_profiles']] == [QOS_KEYS]
    assert all(isinstance(value, str) for value in information['custom_data'].values())


def test_the_file_alone_holds_the_same_metadata_at_its_end(bag):
    with mcap_of(bag).open('rb') as stream:
        records = [record.metadata for record in make_reader(stream).iter_metadata()]
    texts = [yaml.safe_load(record['serialized_metadata']) for record in records]
    beside = yaml.safe_load((bag / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    assert len(texts) == 2
    assert texts[0]['custom_data'] == beside['custom_data']
    assert texts[0]['message_count'] == 0
    assert texts[1] == beside


def test_the_file_alone_is_enough_for_our_reader(bag, trajectory):
    file = mcap_of(bag)
    (bag / 'metadata.yaml').unlink()
    assert read_bag(file).trajectory.sha256() == trajectory.sha256()
