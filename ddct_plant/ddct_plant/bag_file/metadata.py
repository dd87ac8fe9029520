# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""rosbag2's metadata of a bag: `metadata.yaml` and the `rosbag2` record inside the MCAP file."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_plant.base.errors import ParameterError
from ddct_plant.files.output_file import write_text
from ddct_plant.files.yaml_text import dump_yaml, parse_yaml

METADATA_FILE = 'metadata.yaml'
ADVICE = 'free some space or choose another output folder'
"""Advice in the error messages of a bag that cannot be written."""

ROOT_KEY = 'rosbag2_bagfile_information'
RECORD_NAME = 'rosbag2'
RECORD_KEY = 'serialized_metadata'
QOS_KEY = 'offered_qos_profiles'
HASH_KEY = 'topic_type_hash'
SERIALIZATION = 'cdr'

_VERSION = 9
_DISTRO = 'jazzy'
_FOREVER = {'sec': 9223372036, 'nsec': 854775807}
"""Duration without limit as rosbag2 writes it, 2^63 - 1 ns."""


@dataclass(frozen=True)
class Channel:
    """Channel of a bag: one topic, its type, schema and QoS profile."""

    topic: str
    """Resolved name of the topic, with its leading slash."""
    type_name: str
    schema_text: str
    type_hash: str
    qos: str
    """QoS profiles as YAML text, from `offered_qos`."""
    normalise: Callable[[bytes], bytes] = bytes
    """
    Function that makes its serialised messages reproducible; the default leaves them as they
    are.
    """


def offered_qos(*, latched: bool) -> str:
    """Return the YAML list with the QoS profile of a topic's publisher."""
    profile = {
        'history': 'keep_last',
        'depth': 1 if latched else 10,
        'reliability': 'reliable',
        'durability': 'transient_local' if latched else 'volatile',
        'deadline': dict(_FOREVER),
        'lifespan': dict(_FOREVER),
        'liveliness': 'automatic',
        'liveliness_lease_duration': dict(_FOREVER),
        'avoid_ros_namespace_conventions': False,
    }
    return _dump([profile])


def bag_information(
    file_name: str,
    channels: Sequence[Channel],
    counts: Sequence[int],
    first_ns: int,
    last_ns: int,
    custom_data: Mapping[str, str],
) -> dict[str, Any]:
    """
    Return the metadata, version 9, of a bag with one MCAP file, its keys in rosbag2's order.

    `counts` are the numbers of messages by channel, in the order of `channels`.
    """
    count = sum(counts)
    duration = {'nanoseconds': last_ns - first_ns}
    start = {'nanoseconds_since_epoch': first_ns}
    return {
        'version': _VERSION,
        'storage_identifier': 'mcap',
        'duration': duration,
        'starting_time': start,
        'message_count': count,
        'topics_with_message_count': [
            {
                'topic_metadata': {
                    'name': channel.topic,
                    'type': channel.type_name,
                    'serialization_format': SERIALIZATION,
                    'offered_qos_profiles': parse_yaml(channel.qos),
                    'type_description_hash': channel.type_hash,
                },
                'message_count': messages,
            }
            for channel, messages in zip(channels, counts, strict=True)
        ],
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [file_name],
        'files': [
            {
                'path': file_name,
                'starting_time': dict(start),
                'duration': dict(duration),
                'message_count': count,
            }
        ],
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
