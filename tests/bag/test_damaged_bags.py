# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Missing, cut, damaged and foreign bags have distinct errors and are never read as complete."""

import pytest
import yaml
from mcap.writer import Writer
from refusals import refused
from support.damages import tried_damages

from ddct_bringup.bag.reader import mcap_of, read_bag
from ddct_bringup.bag.writer import BagWriter
from ddct_plant.bag_file.records import read_records
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import recorded_topics


def test_a_missing_bag_is_an_error(tmp_path):
    with pytest.raises(DdctError, match='no such file or folder'):
        read_bag(tmp_path / 'nothing')


def test_a_folder_without_a_bag_is_an_error(tmp_path):
    with pytest.raises(DdctError, match='no .mcap file in this folder'):
        read_bag(tmp_path)


@pytest.mark.parametrize(('content', 'message'), [(b'', 'is empty'), (b'hello', 'not an MCAP')])
def test_a_file_that_is_no_mcap_is_an_error(tmp_path, content, message):
    file = tmp_path / 'x.mcap'
    file.write_bytes(content)
    with pytest.raises(DdctError, match=f'x.mcap: .*{message}'):
        read_bag(file)


def test_whatever_is_damaged_a_bag_is_refused_or_the_beginning_of_the_true_one(bags, trajectory):
    counts = tried_damages(mcap_of(bags.write(trajectory)), trajectory, 24, seed=5)
    assert counts['refused'] > 12
    assert counts['unfinished'] > 2


def test_a_foreign_bag_is_reported_as_foreign(tmp_path):
    file = tmp_path / 'foreign.mcap'
    with file.open('wb') as stream:
        writer = Writer(stream)
        writer.start(profile='ros2')
        schema = writer.register_schema('std_msgs/msg/Header', 'ros2msg', b'string frame_id')
        writer.register_channel('/chatter', 'cdr', schema)
        writer.finish()
    with refused(DdctError, '/driveline/joint_states', place='foreign.mcap'):
        read_bag(file)


@pytest.mark.parametrize(
    ('type_name', 'encoding', 'text', 'message'),
    [
        ('std_msgs/msg/Header', 'ros2msg', b'string frame_id', 'does not carry CDR messages'),
        ('sensor_msgs/msg/JointState', 'jsonschema', b'{}', 'does not carry CDR messages'),
        ('sensor_msgs/msg/JointState', 'ros2msg', b'what is this?', 'does not carry CDR messages'),
        (
            'sensor_msgs/msg/JointState',
            'ros2msg',
            b'string} \x1b[2J',
            'unusable message definition',
        ),
        ('sensor_msgs/msg/JointState', 'ros2msg', b'string[] name', 'does not carry CDR messages'),
    ],
)
def test_a_foreign_type_on_our_topic_is_an_error(
    bags, trajectory, tmp_path, capsys, type_name, encoding, text, message
):
    file = tmp_path / 'foreign.mcap'
    custom_data = read_bag(bags.write(trajectory)).custom_data
    with file.open('wb') as stream:
        writer = Writer(stream)
        writer.start(profile='ros2')
        record = {'serialized_metadata': yaml.safe_dump({'custom_data': custom_data})}
        writer.add_metadata('rosbag2', record)
        schema = writer.register_schema(type_name, encoding, text)
        channel = writer.register_channel('/driveline/joint_states', 'cdr', schema)
        writer.add_message(channel, 1_000_000_000, b'\x00\x01\x00\x00' + bytes(8), 0)
        writer.finish()
    with pytest.raises(DdctError, match=f'foreign.mcap: /driveline/joint_states.* {message}'):
        read_bag(file)
    assert capsys.readouterr().err == ''


def test_a_bag_without_the_settings_of_the_run_is_reported_as_foreign(bags, trajectory):
    source = read_records(mcap_of(bags.write(trajectory)))
    bare = bags.folder / 'bare'
    with BagWriter(bare, 'bare', recorded_topics(RunKind()), {'version': '1.0'}) as writer:
        for message in source.messages():
            writer.write(*message)
    with refused(DdctError, 'settings', place='bare_0.mcap'):
        read_bag(bare)


def without(topic, step):
    return lambda messages: [
        message for message in messages if message[:2] != (topic, stamp_of_step(step))
    ]


def test_a_missing_message_is_named(bags, trajectory):
    bag = bags.rewrite(bags.write(trajectory), 'gap', without('/load/torque', 17))
    with refused(DdctError, '/load/torque', place='gap_0.mcap'):
        read_bag(bag)


def test_a_missing_acknowledgement_is_named(bags, trajectory):
    bag = bags.rewrite(bags.write(trajectory), 'gap', without('/recorder/ack', 60))
    with refused(DdctError, '/recorder/ack', place='gap_0.mcap'):
        read_bag(bag)


def test_a_doubled_message_is_named(bags, trajectory):
    bag = bags.rewrite(
        bags.write(trajectory), 'double', lambda messages: [*messages, messages[-1]]
    )
    with refused(DdctError, '/recorder/ack', place='double_0.mcap'):
        read_bag(bag)


def test_a_message_under_another_stamp_is_an_error(bags, trajectory):
    def swap(messages):
        topic, _, data = messages[-1]
        return [*messages[:-1], (topic, stamp_of_step(61), data)]

    bag = bags.rewrite(bags.write(trajectory), 'shifted', swap)
    with refused(DdctError, '/recorder/ack', place='shifted_0.mcap'):
        read_bag(bag)


@pytest.mark.parametrize('topic', ['/clutch/slip', '/controller/status'])
def test_messages_in_the_places_of_one_another_are_an_error(bags, trajectory, topic):
    def swap(messages):
        first, second = (messages.index(each) for each in messages if each[:2] in places)
        (_, early, one), (_, late, other) = messages[first], messages[second]
        messages[first], messages[second] = (topic, early, other), (topic, late, one)
        return messages

    places = [(topic, stamp_of_step(step)) for step in (20, 30)]
    bag = bags.rewrite(bags.write(trajectory), 'swapped', swap)
    with refused(DdctError, topic, place='swapped_0.mcap') as caught:
        read_bag(bag)
    assert f'carries the stamp {stamp_of_step(30)} ns' in str(caught.value)


def test_real_time_bags_hold_the_last_reply(bags, trajectory):
    def thin_out(messages):
        for step in (0, 20, 21, 60):
            messages = without('/clutch/torque_request', step)(messages)
        return messages

    bag = bags.rewrite(bags.write(trajectory), 'rt', thin_out, mode='realtime')
    recording = read_bag(bag)
    expected = trajectory.torque_request.copy()
    expected[0] = expected[1]
    expected[20:22] = expected[19]
    expected[60] = expected[59]
    assert recording.trajectory.torque_request.tolist() == expected.tolist()
    assert recording.missed == {'clutch/torque_request': 4}


def test_real_time_bags_must_have_every_state(bags, trajectory):
    bag = bags.rewrite(
        bags.write(trajectory), 'rt', without('/driveline/joint_states', 9), mode='realtime'
    )
    with refused(DdctError, '/driveline/joint_states', place='rt_0.mcap'):
        read_bag(bag)


def test_a_reply_that_never_came_is_an_error_in_real_time_too(bags, trajectory):
    bag = bags.rewrite(
        bags.write(trajectory),
        'rt',
        lambda messages: [message for message in messages if message[0] != '/clutch/torque'],
        mode='realtime',
    )
    with refused(DdctError, '/clutch/torque', place='rt_0.mcap'):
        read_bag(bag)


def _with_second_run_info(old, new):
    """Return an edit that repeats the run_info of node load, with `old` replaced by `new`."""

    def edit(messages):
        at = next(i for i, (_, _, data) in enumerate(messages) if b'load' in data)
        topic, stamp, data = messages[at]
        again = (topic, stamp, data.replace(old, new))
        return [*messages[: at + 1], again, *messages[at + 1 :]]

    return edit


def test_two_different_run_info_of_one_node_are_refused_by_name(bags, trajectory):
    bag = bags.rewrite(bags.write(trajectory), 'two', _with_second_run_info(b'1.0', b'2.0'))
    with refused(DdctError, 'version', place='two_0.mcap'):
        read_bag(bag)


def test_the_same_run_info_twice_is_no_error(bags, trajectory):
    bag = bags.rewrite(bags.write(trajectory), 'twice', _with_second_run_info(b'1.0', b'1.0'))
    assert read_bag(bag).run_info['/load'] == {'version': '1.0'}
