# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Requirements on error messages for users."""

import re


def assert_one_line(errors: str, program: str, *needles: str) -> None:
    """
    Require one line `<program>: <text>` that holds every needle, and no traceback.

    Log lines of ROS (`[ERROR] [...]`) are ignored.
    """
    lines = [
        line for line in errors.splitlines() if line.strip() and not re.match(r'\[\w+\] \[', line)
    ]
    assert len(lines) == 1, errors
    assert lines[0].startswith(f'{program}: '), errors
    for needle in needles:
        assert needle in lines[0], f'{needle!r} is not in: {lines[0]}'
