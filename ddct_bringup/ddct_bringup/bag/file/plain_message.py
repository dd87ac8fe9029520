"""Messages without ROS: made and serialised by the MCAP library, from their definitions."""

from collections.abc import Callable
from functools import cache, partial
from typing import Any

from mcap_ros2._dynamic import generate_dynamic, serialize_dynamic

from ddct_bringup.bag.file.message_definitions import load_definition

_ZEROS = b'\x00\x01' + bytes(510)
"""More than any of the types needs: zeros decode as zeros, empty texts and empty lists."""


def plain_class(type_name: str) -> Callable[..., Any]:
    """Return what makes messages of a type, as its ROS class does: `new(field=value)`."""
    return partial(_new, type_name)


@cache
def serialiser(type_name: str) -> Callable[[Any], bytes]:
    """Return what turns a message of a type into CDR, the same bytes as ROS's own."""
    return serialize_dynamic(type_name, load_definition(type_name).schema_text)[type_name]


def _new(type_name: str, **values: Any) -> Any:
    message = _decoder(type_name)(_ZEROS)
    for name, value in values.items():
        setattr(message, name, value)
    return message


@cache
def _decoder(type_name: str) -> Callable[[bytes], Any]:
    return generate_dynamic(type_name, load_definition(type_name).schema_text)[type_name]
