# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""rosbag2's metadata of a bag: `metadata.yaml` and the `rosbag2` record inside the MCAP file."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.output_file import write_text
from ddct_plant.files.yaml_text import dump_yaml, parse_yaml
from ddct_plant.signals.topic import Topic

METADATA_FILE = 'metadata.yaml'
ADVICE = 'free some space or choose another output folder'
"""Advice in the error messages of a bag that cannot be written."""

ROOT_KEY = 'rosbag2_bagfile_information'
RECORD_NAME = 'rosbag2'
RECORD_KEY = 'serialized_metadata'
SERIALIZATION = 'cdr'

_VERSION = 9
_DISTRO = 'jazzy'
_FOREVER = {'sec': 9223372036, 'nsec': 854775807}
"""Duration without limit as rosbag2 writes it, 2^63 - 1 ns."""


def qos_of(topic: Topic) -> dict[str, Any]:
    """Return the QoS profile of a topic's publisher."""
    return _qos(topic.latched)


def _qos(latched: bool) -> dict[str, Any]:
    return {
        'history': 'keep_last',
        'depth': 1 if latched else 10,
        'reliability': 'reliable',
        'durability': 'transient_local' if latched else 'volatile',
        'deadline': _FOREVER,
        'lifespan': _FOREVER,
        'liveliness': 'automatic',
        'liveliness_lease_duration': _FOREVER,
        'avoid_ros_namespace_conventions': False,
    }


def channel_metadata(topic: Topic) -> dict[str, str]:
    """Return the metadata of a topic's channel."""
    type_hash = load_definition(topic.type).type_hash
    return {'offered_qos_profiles': _qos_text(topic.latched), 'topic_type_hash': type_hash}


@cache
def _qos_text(latched: bool) -> str:
    return _dump([_qos(latched)])


def bag_information(
    file_name: str,
    counts: Mapping[Topic, int],
    first_ns: int,
    last_ns: int,
    custom_data: Mapping[str, str],
) -> dict[str, Any]:
    """
    Return the metadata, version 9, of a bag with one MCAP file, its keys in rosbag2's order.

    `counts` are the numbers of messages by topic, in the order of the channels.
    """
    of_file = {
        'starting_time': {'nanoseconds_since_epoch': first_ns},
        'duration': {'nanoseconds': last_ns - first_ns},
        'message_count': sum(counts.values()),
    }
    return {
        'version': _VERSION,
        'storage_identifier': 'mcap',
        **{name: of_file[name] for name in ('duration', 'starting_time', 'message_count')},
        'topics_with_message_count': [
            {
                'topic_metadata': {
                    'name': topic.resolved_name,
                    'type': topic.type,
                    'serialization_format': SERIALIZATION,
                    'offered_qos_profiles': [qos_of(topic)],
                    'type_description_hash': load_definition(topic.type).type_hash,
                },
                'message_count': count,
            }
            for topic, count in counts.items()
        ],
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [file_name],
        'files': [{'path': file_name, **of_file}],
        'custom_data': dict(custom_data),
        'ros_distro': _DISTRO,
    }


def metadata_record(information: Mapping[str, Any]) -> dict[str, str]:
    """Return the content of the `rosbag2` metadata record, which has no root key."""
    return {RECORD_KEY: _dump(dict(information))}


def write_metadata(folder: Path, information: Mapping[str, Any]) -> None:
    """Write `metadata.yaml` completely or not at all; raise DdctError when that fails."""
    write_text(str(folder / METADATA_FILE), _dump({ROOT_KEY: dict(information)}), ADVICE)


def information_of(record: Mapping[str, str]) -> dict[str, Any]:
    """Return the content of a `rosbag2` metadata record; empty where it cannot be parsed."""
    try:
        information = parse_yaml(record.get(RECORD_KEY, ''))
    except ParameterError:
        return {}
    return information if isinstance(information, dict) else {}


def _dump(value: Any) -> str:
    return dump_yaml(value, allow_unicode=True, width=1000)
