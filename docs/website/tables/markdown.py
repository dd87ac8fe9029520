# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables as Markdown."""

from collections.abc import Sequence

from ddct_plant.program.table import TextTable


def as_markdown(table: TextTable) -> str:
    """Return a table as Markdown, with a final line end."""
    separator = ['---'] * len(table.headers)
    return ''.join(f'{_line(cells)}\n' for cells in (table.headers, separator, *table.rows))


def _line(cells: Sequence[str]) -> str:
    escaped = (cell.replace('|', r'\|').replace('\n', ' ') for cell in cells)
    return f'| {" | ".join(escaped)} |'
