# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Normalising serialised messages changes exactly the bytes that carry no value."""

from functools import cache

import pytest
from mcap_ros2._dynamic import generate_dynamic, serialize_dynamic
from refusals import refused
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from ddct_plant.bag_file.cdr import CdrDecoder, CdrNormaliser
from ddct_plant.bag_file.message_definitions import definition_in, load_definition
from ddct_plant.base.errors import DdctError

STAMP = {'sec': 3, 'nanosec': 70_000_000}
HEADER = {'stamp': STAMP, 'frame_id': ''}
MESSAGES = {
    'rosgraph_msgs/msg/Clock': {'clock': STAMP},
    'std_msgs/msg/Header': HEADER,
    'geometry_msgs/msg/WrenchStamped': {'header': HEADER, 'wrench': {'torque': {'x': 1.5}}},
    'sensor_msgs/msg/JointState': {
        'header': {'stamp': STAMP, 'frame_id': 'a'},
        'name': ['engine', 'wheel'],
        'position': [1.0, 2.0],
        'velocity': [3.0],
        'effort': [],
    },
    'trajectory_msgs/msg/JointTrajectory': {
        'header': HEADER,
        'joint_names': ['clutch'],
        'points': [
            {'effort': [float(i)], 'time_from_start': {'sec': 0, 'nanosec': i * 1_000_000}}
            for i in range(11)
        ],
    },
    'diagnostic_msgs/msg/DiagnosticArray': {
        'header': HEADER,
        'status': [
            {
                'level': 1,
                'name': 'controller',
                'message': 'x',
                'values': [{'key': 'a', 'value': '1.25'}, {'key': 'bcd', 'value': ''}],
            }
        ],
    },
    'made_msgs/msg/Fix': {
        'header': HEADER,
        'status': {'status': 1, 'service': 2},
        'latitude': 1.0,
        'covariance': [float(i) for i in range(9)],
        'covariance_type': 1,
        'few': [2.0],
        'short': 'abc',
        'count': 3,
        'letter': 65,
        'change': -3,
        'time_ns': 1 << 40,
        'serial': 1 << 63,
        'height': 0.5,
    },
}
# Fixed and bounded arrays, single bytes and eight-byte fields behind them.
FIX = f"""\
std_msgs/Header header
made_msgs/FixStatus status
float64 latitude
float64[9] covariance
uint8 covariance_type
float64[<=3] few
string<=5 short
uint32 count
char letter
int16 change
int64 time_ns
uint64 serial
float32 height
{'=' * 80}
MSG: made_msgs/FixStatus
int8 NO=-1
int8 status
uint16 service
"""


@cache
def store():
    """Return the types of ROS, and one that is made for the tests."""
    found = get_typestore(Stores.ROS2_JAZZY)
    found.register(get_types_from_msg(FIX, 'made_msgs/msg/Fix'))
    return found


@pytest.fixture(params=MESSAGES)
def case(request):
    """Return the type name, a serialiser's bytes and a decoder."""
    definition = definition_in(store(), request.param)
    serialise = serialize_dynamic(request.param, definition.schema_text)[request.param]
    decode = generate_dynamic(request.param, definition.schema_text)[request.param]
    return definition, serialise(MESSAGES[request.param]), decode


def decodes_to(decode, data, message):
    try:
        return decode(data) == message
    except Exception:
        return False


def test_a_clean_message_stays_as_it_is(case):
    definition, clean, _ = case
    assert CdrNormaliser(definition).normalise(clean) == clean


def test_exactly_the_bytes_without_a_value_are_ignored(case):
    definition, clean, decode = case
    message = decode(clean)
    for place in range(4, len(clean)):
        spoiled = bytearray(clean)
        spoiled[place] ^= 0x55
        try:
            ignored = CdrNormaliser(definition).normalise(bytes(spoiled)) == clean
        except DdctError:
            ignored = False
        assert ignored == decodes_to(decode, bytes(spoiled), message), place


def test_a_stored_layout_gives_the_same_as_a_new_one(case):
    definition, clean, decode = case
    used = CdrNormaliser(definition)
    used.normalise(clean)
    message = decode(clean)
    for place in range(4, len(clean)):
        spoiled = bytearray(clean)
        spoiled[place] ^= 0x55
        if decodes_to(decode, bytes(spoiled), message):
            assert used.normalise(bytes(spoiled)) == clean


def test_what_follows_the_message_is_cut(case):
    definition, clean, _ = case
    assert CdrNormaliser(definition).normalise(clean + b'\xaa' * 8) == clean


def test_option_bytes_of_the_header_are_cleared(case):
    definition, clean, _ = case
    assert CdrNormaliser(definition).normalise(clean[:2] + b'\x00\x03' + clean[4:]) == clean


def test_a_message_that_is_cut_short_is_an_error(case):
    definition, clean, _ = case
    for length in range(len(clean)):
        with refused(DdctError, definition.type_name):
            CdrNormaliser(definition).normalise(clean[:length])


def test_two_layouts_of_the_same_length_are_distinguished():
    definition = load_definition('diagnostic_msgs/msg/DiagnosticArray')
    serialise = serialize_dynamic(definition.type_name, definition.schema_text)
    normaliser = CdrNormaliser(definition)

    def message(key, value):
        status = {'name': 'n', 'values': [{'key': key, 'value': value}]}
        return serialise[definition.type_name]({'header': HEADER, 'status': [status]})

    first, second = message('ab', 'abcdefg'), message('abcdef', 'abc')
    assert len(first) == len(second)
    for data in (first, second, first):
        assert normaliser.normalise(data) == data


def same(message, expected):
    """Return whether a message has the values of one that the general decoder returned."""
    if isinstance(expected, list):
        return len(message) == len(expected) and all(map(same, message, expected))
    if not hasattr(expected, '_type'):
        return type(message) is type(expected) and message == expected
    return all(
        same(getattr(message, name), getattr(expected, name)) for name in expected.__slots__
    )


def test_a_decoded_message_has_the_values_that_the_general_decoder_returns(case):
    definition, clean, decode = case
    assert same(CdrDecoder(definition)(clean), decode(clean))
    with pytest.raises(AttributeError, match='no_field'):
        CdrDecoder(definition)(clean).no_field  # noqa: B018


def test_other_values_at_the_same_places_are_decoded_anew(case):
    definition, clean, decode = case
    decoder = CdrDecoder(definition)
    decoder(clean)
    for place in range(4, len(clean)):
        spoiled = bytearray(clean)
        spoiled[place] ^= 0x15
        try:
            message = decoder(bytes(spoiled))
        except DdctError:
            continue  # a length is spoiled
        assert same(message, decode(bytes(spoiled))), place
    assert same(decoder(clean), decode(clean))


def test_a_text_that_is_none_is_an_error_even_if_nobody_reads_it():
    definition = load_definition('sensor_msgs/msg/JointState')
    serialise = serialize_dynamic(definition.type_name, definition.schema_text)
    data = serialise[definition.type_name](MESSAGES[definition.type_name])
    with pytest.raises(UnicodeDecodeError):
        CdrDecoder(definition)(data.replace(b'wheel', b'whe\xffl'))


def test_a_message_in_another_encoding_is_left_to_the_general_decoder(case):
    definition, clean, _ = case
    for other in (b'\x00\x00' + clean[2:], clean[:-1], b''):
        with pytest.raises(DdctError, match='a message is no '):
            CdrDecoder(definition)(other)
