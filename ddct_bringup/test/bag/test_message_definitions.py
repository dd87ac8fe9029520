# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The message definitions equal those of the ROS installation, without its comments."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from refusals import refused

from ddct_plant.bag_file.message_definitions import (
    all_types,
    decode,
    definition_in,
    encode,
    load_definition,
    message_class,
    same_definition,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.signals.topics import TOPICS

TYPES = sorted({name for topic in TOPICS for name in load_definition(topic.type).fields})


def installed(type_name, suffix):
    """Return the text of a type's file that the ROS packages have installed."""
    package, _, name = type_name.partition('/msg/')
    try:
        from ament_index_python.packages import get_package_share_directory

        share = Path(get_package_share_directory(package))
    except ImportError:
        pytest.skip('ROS is not installed')
    except LookupError:  # the wheels set no AMENT_PREFIX_PATH; their prefix is Python's own
        share = Path(sys.prefix) / 'share' / package
    return (share / 'msg' / f'{name}{suffix}').read_text(encoding='utf-8')


def stripped(type_name):
    """Return the lines of the installed definition without comments, type names in full."""
    lines = []
    for line in installed(type_name, '.msg').splitlines():
        words = line.partition('#')[0].split()
        if not words:
            continue
        if words[0].rstrip('[]') in ('KeyValue', 'DiagnosticStatus', 'JointTrajectoryPoint'):
            words[0] = f'{type_name.partition("/")[0]}/{words[0]}'
        elif words[0] in ('Accel', 'Twist', 'Vector3', 'Wrench'):
            words[0] = f'geometry_msgs/{words[0]}'
        lines.append(re.sub(' ?= ?', '=', ' '.join(words)))
    return lines


@pytest.mark.parametrize('type_name', TYPES)
def test_fields_and_constants_are_those_of_ros(type_name):
    text = load_definition(type_name).schema_text.partition('\n===')[0]
    assert text.split('\n')[: len(stripped(type_name))] == stripped(type_name)
    assert not text.split('\n', len(stripped(type_name)))[-1].strip()


@pytest.mark.parametrize('type_name', TYPES)
def test_the_hash_is_that_of_ros(type_name):
    hashes = json.loads(installed(type_name, '.json'))['type_hashes']
    found = load_definition(type_name).type_hash
    assert {'type_name': type_name, 'hash_string': found} in hashes


@pytest.mark.parametrize('type_name', sorted({topic.type for topic in TOPICS}))
def test_a_message_made_without_ros_is_serialised_as_one_of_ros(type_name):
    serialization = pytest.importorskip('rclpy.serialization', reason='ROS is not installed')
    from ddct_plant.bag_file.cdr import CdrNormaliser
    from ddct_plant.signals.message_kind import ros_class

    clean = CdrNormaliser(load_definition(type_name)).normalise
    theirs = clean(serialization.serialize_message(ros_class(type_name)()))
    assert encode(message_class(type_name)()) == theirs


@pytest.mark.parametrize('type_name', sorted({topic.type for topic in TOPICS}))
def test_the_definition_in_our_file_is_that_of_rosbags(type_name):
    """`tools/run definitions` writes the file again."""
    assert load_definition(type_name) == definition_in(all_types(), type_name)
    ours = type(message_class(type_name)())
    assert ours is not all_types().types[type_name], 'it was not taken from the file'


def test_a_message_of_a_type_that_no_topic_has_is_serialised_and_read_too():
    message = message_class('std_msgs/msg/Float64')(data=2.5)
    assert decode(encode(message), 'std_msgs/msg/Float64').data == 2.5
    assert same_definition('std_msgs/msg/Float64', '# a number\nfloat64 data\n')


@pytest.mark.process
def test_a_bag_of_our_topics_is_read_without_the_other_types_of_rosbags():
    code = (
        'import sys\n'
        'from ddct_plant.bag_file.message_definitions import *\n'
        f'for name in {sorted({topic.type for topic in TOPICS})}:\n'
        '    load_definition(name)\n'
        "assert not [name for name in sys.modules if name.startswith('rosbags')]\n"
        "decode(encode(message_class('rosgraph_msgs/msg/Clock')()), 'rosgraph_msgs/msg/Clock')\n"
        "print([name for name in sys.modules if 'stores.ros2' in name])\n"
    )
    found = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True)
    assert (found.stdout, found.stderr) == ('[]\n', '')


def test_a_type_that_ros_does_not_have_is_named():
    with refused(DdctError, 'a_msgs/msg/B'):
        load_definition('a_msgs/msg/B')


def test_a_definition_with_comments_is_the_same_and_one_with_another_field_is_not():
    clock = 'rosgraph_msgs/msg/Clock'
    text = load_definition(clock).schema_text
    assert same_definition(clock, text)
    assert same_definition(clock, f'# the time\n{text}')
    assert not same_definition(clock, text.replace('uint32', 'int32'))
    assert not same_definition(clock, text.replace(' clock', ' time'))
    assert not same_definition(clock, 'what is this?')
    with pytest.raises(DdctError, match='unusable message definition'):
        same_definition(clock, 'string} \x1b[2J')
