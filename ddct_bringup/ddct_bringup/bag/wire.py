"""What can be told of a recorded topic's messages while they are still serialised."""

import struct

from ddct_plant.graph.message_kinds import NS_PER_S

_STAMP = struct.Struct('<iI')
_STAMP_AT = 4
"""Every recorded type begins with its stamp, right behind the four bytes of the encapsulation."""


def stamp_of_cdr(cdr: bytes) -> int:
    """Return the stamp in ns of a serialised message."""
    seconds, nanoseconds = _STAMP.unpack_from(cdr, _STAMP_AT)
    return seconds * NS_PER_S + nanoseconds
