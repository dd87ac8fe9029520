# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The message definitions equal those of the ROS installation, without its comments."""

import json
import re
import sys
from pathlib import Path

import pytest
from refusals import refused

from ddct_bringup.bag.trajectory_bag import plain_class
from ddct_plant.bag_file.message_definitions import (
    definition_in,
    load_definition,
    message_types,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.signals.topics import TOPICS

TYPES = message_types()


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
    assert TYPES[type_name]['fields'] == stripped(type_name)


@pytest.mark.parametrize('type_name', TYPES)
def test_the_hash_is_that_of_ros(type_name):
    hashes = json.loads(installed(type_name, '.json'))['type_hashes']
    assert {'type_name': type_name, 'hash_string': TYPES[type_name]['hash']} in hashes


def test_every_type_on_the_graph_is_defined_and_no_other():
    used = {name for topic in TOPICS for name in load_definition(topic.type).fields}
    assert used == set(TYPES)


@pytest.mark.parametrize('type_name', sorted({topic.type for topic in TOPICS}))
def test_a_message_made_without_ros_is_serialised_as_one_of_ros(type_name):
    serialization = pytest.importorskip('rclpy.serialization', reason='ROS is not installed')
    from ddct_bringup.bag.trajectory_bag import serialiser
    from ddct_plant.bag_file.cdr import CdrNormaliser
    from ddct_plant.signals.message_kind import ros_class

    clean = CdrNormaliser(load_definition(type_name)).normalise
    theirs = clean(serialization.serialize_message(ros_class(type_name)()))
    assert serialiser(type_name)(plain_class(type_name)()) == theirs


def test_a_type_that_is_not_defined_is_named():
    with refused(DdctError, 'a_msgs/msg/B'):
        definition_in({'c/msg/C': {'hash': '', 'fields': ['a_msgs/B b']}}, 'c/msg/C')


def test_a_line_that_is_no_field_is_named():
    with pytest.raises(DdctError, match="'float64' is no field"):
        definition_in({'c/msg/C': {'hash': '', 'fields': ['float64']}}, 'c/msg/C')
