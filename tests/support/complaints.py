# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Requirements on error messages for users."""

import re

_MIDDLEWARE_LOG = re.compile(
    r'^\x1b\[37;1m[\d-]+ [\d:.]+ \x1b\[\S+\[[^\n]*RTPS_[^\n]*\n', re.MULTILINE
)
"""
Line of the log of Fast DDS, which writes to the standard error of a program by itself.

Two programs that start at once may open a port in shared memory while the other removes it: it
logs that as an error, and takes the next port.
"""


def without_middleware_log(printed: str) -> str:
    """Return what a program has printed without the lines of the middleware's log."""
    return _MIDDLEWARE_LOG.sub('', printed)


def assert_one_line(errors: str, program: str, *needles: str) -> None:
    """
    Require one line `<program>: <text>` that holds every needle, and no traceback.

    Log lines of ROS (`[ERROR] [...]`) and of its middleware are ignored.
    """
    lines = [
        line
        for line in without_middleware_log(errors).splitlines()
        if line.strip() and not re.match(r'\[\w+\] \[', line)
    ]
    assert len(lines) == 1, errors
    assert lines[0].startswith(f'{program}: '), errors
    for needle in needles:
        assert needle in lines[0], f'{needle!r} is not in: {lines[0]}'
