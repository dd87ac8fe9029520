# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What holds for every printed table: whole lines of some width, and a reason for each dash."""

import re
from collections.abc import Sequence


def require_whole_lines(lines: Sequence[str], width: int) -> None:
    """Require lines that are no wider than `width` and have no cell that is cut."""
    assert lines
    assert [line for line in lines if len(line) > width] == []
    assert [line for line in lines if '…' in line or '...' in line] == []


def require_reasons(lines: Sequence[str]) -> None:
    """Require a note below each table for each kind of dash in it, and few notes."""
    for table in '\n'.join(lines).split('\n\n'):
        cells = {cell for line in table.splitlines() for cell in re.split('  +', line.strip())}
        notes = [line for line in table.splitlines() if re.match(r'  (-+|\*+)  ', line)]
        dashes = {cell for cell in cells if re.fullmatch('-+', cell)}
        assert {note.split()[0] for note in notes} >= dashes, table
        assert len(notes) <= 6
