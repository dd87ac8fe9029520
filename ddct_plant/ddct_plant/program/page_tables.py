"""Fill the tables of a documentation page; what stands around them is kept."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import read_text_file
from ddct_plant.program.table import Table


def read_page(path: str) -> str:
    """Return the text of the page that `--write-doc` names; raise DdctError without one."""
    try:
        return read_text_file(Path(path))
    except OSError as error:
        raise DdctError(f'--write-doc {path}: cannot be read ({error.strerror})') from error


def marked_tables(page: str, program: str) -> list[str]:
    """Return the names of the tables that the page marks for a program, in its order."""
    return [match[2] for match in _block(program).finditer(page)]


def fill_tables(page: str, program: str, tables: Mapping[str, Table]) -> str:
    """
    Return the page with every table in the place that its name marks.

    A table stands between the lines `<!-- PROGRAM: NAME -->` and `<!-- end -->`. Raise DdctError
    unless the page has each table once and no other of this program.
    """
    names = marked_tables(page, program)
    if sorted(names) != sorted(tables):
        raise DdctError(
            f'--write-doc: the page must have these tables, each once: {", ".join(tables)}; '
            f'it has: {", ".join(names) or "none"}'
        )
    return _block(program).sub(
        lambda match: f'{match[1]}{_markdown(tables[match[2]])}\n{match[3]}', page
    )


def _block(program: str) -> re.Pattern[str]:
    return re.compile(rf'(<!-- {re.escape(program)}: (\w+) -->\n).*?(<!-- end -->)', re.DOTALL)


def _markdown(table: Table) -> str:
    separator = ['---'] * len(table.headers)
    return '\n'.join(_line(cells) for cells in (table.headers, separator, *table.rows))


def _line(cells: Sequence[str]) -> str:
    escaped = (cell.replace('|', r'\|') for cell in cells)
    return f'| {" | ".join(escaped)} |'
