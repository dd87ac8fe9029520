"""Message definitions of the ROS installation: schema text, type hash and field types."""

import json
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory

from ddct_plant.base.errors import DdctError

_SEPARATOR = '=' * 80


@dataclass(frozen=True)
class MessageDefinition:
    """What a bag says about a message type."""

    type_name: str
    """Such as 'std_msgs/msg/Header'."""
    schema_text: str
    """The .msg text, then that of each type inside it, once, depth first."""
    type_hash: str
    """RIHS01 hash of the type."""
    fields: dict[str, list[dict[str, Any]]]
    """Fields of the type and of each type inside it, by type name, as the .json beside it."""


@cache
def load_definition(type_name: str) -> MessageDefinition:
    """Read the definition of a type such as 'std_msgs/msg/Header'; raise DdctError without it."""
    file = _definition_file(type_name, '.json')
    try:
        description = json.loads(file.read_text(encoding='utf-8'))
        types = description['type_description_msg']
        fields = {
            entry['type_name']: entry['fields']
            for entry in [types['type_description'], *types['referenced_type_descriptions']]
        }
        hashes = {entry['type_name']: entry['hash_string'] for entry in description['type_hashes']}
        return MessageDefinition(
            type_name, _schema_text(type_name, fields), hashes[type_name], fields
        )
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise DdctError(
            f'{file}: cannot read the definition of {type_name} ({error!r}): '
            'install the ROS message packages again'
        ) from error


def _schema_text(type_name: str, fields: dict[str, list[dict[str, Any]]]) -> str:
    """Return the .msg text of the type followed by those of the types inside it."""
    order: list[str] = []

    def visit(name: str) -> None:
        if name not in order:
            order.append(name)
            for field in fields[name]:
                if nested := field['type']['nested_type_name']:
                    visit(nested)

    visit(type_name)
    text = _definition_file(type_name, '.msg').read_text(encoding='utf-8')
    for name in order[1:]:
        nested_text = _definition_file(name, '.msg').read_text(encoding='utf-8')
        text += f'\n{_SEPARATOR}\nMSG: {name.replace("/msg/", "/")}\n{nested_text}'
    return text


def _definition_file(type_name: str, suffix: str) -> Path:
    package, _, name = type_name.partition('/msg/')
    return _share(package) / 'msg' / f'{name}{suffix}'


def _share(package: str) -> Path:
    """Return share/<package>: through the ament index, else of the environment Python runs in."""
    try:
        return Path(get_package_share_directory(package))
    except (PackageNotFoundError, OSError):
        # The ROS wheels set no AMENT_PREFIX_PATH; their prefix is Python's own.
        share = Path(sys.prefix) / 'share' / package
    if not share.is_dir():
        raise DdctError(
            f'no message definitions of {package} in AMENT_PREFIX_PATH or {sys.prefix}: '
            'source the ROS setup file, or install ros-jazzy-common-interfaces'
        )
    return share
