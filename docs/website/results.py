# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of results that only the site has, from the files that programs write for `make docs`."""

import shutil
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from ddct_bringup.reproduction.numbers.gate import NumbersDocument
from ddct_bringup.reproduction.studies.study import WrittenStudy
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import read_json
from ddct_plant.program.table import TextTable, WrittenTable
from website.tables.markdown import as_markdown

FILES: Mapping[str, Any] = {
    'numbers': NumbersDocument,
    'benchmark': Mapping[str, WrittenTable],
    'studies': Mapping[str, WrittenStudy],
}
"""Types of the files, by their name without `.json`."""


def result_table(file: str, name: str, results: Path, pictures: Path) -> str:
    """
    Return a table of `FILE.json` in the folder `results` as Markdown.

    A picture NAME.png beside the file goes above its table, and is copied into `pictures`, a
    folder beside the page. Raise DdctError for a table that no file has.
    """
    if file not in FILES or name not in (tables := _tables(file, results)):
        raise DdctError(f'{results / file}.json has no table {name}: make docs')
    table = tables[name]
    rows = [[row[header] for header in table.headers] for row in table.rows]
    written = as_markdown(TextTable(table.title, table.headers, rows))
    picture = results / f'{name}.png'
    if not picture.is_file():
        return written
    pictures.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(picture, pictures / picture.name)
    return f'![{table.title}]({pictures.name}/{picture.name})\n\n{written}'


@cache
def _tables(file: str, folder: Path) -> Mapping[str, WrittenTable]:
    """Return the tables of a file by name; raise DdctError where it cannot be read."""
    content: Any = read_json(FILES[file], folder / f'{file}.json', advice='make docs')
    tables = content.tables if file == 'numbers' else content
    return {name: each.table if file == 'studies' else each for name, each in tables.items()}
