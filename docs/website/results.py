# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Tables of results that only the site has, from the files that programs write.

A page has the mark `<!-- table: FILE NAME -->` on a line of its own, where the site has the table
NAME of FILE.json. `make site` makes the files. A picture NAME.png beside them goes above its
table.
"""

import re
import shutil
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from generator.markdown import as_markdown

from ddct_bringup.reproduction.numbers.gate import NumbersDocument
from ddct_bringup.reproduction.studies.study import WrittenStudy
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import read_json
from ddct_plant.program.table import TextTable, WrittenTable

FILES: Mapping[str, Any] = {
    'numbers': NumbersDocument,
    'benchmark': Mapping[str, WrittenTable],
    'studies': Mapping[str, WrittenStudy],
}
"""Types of the files, by their name without `.json`."""
MARK = re.compile(r'^<!-- table: (\w+) (\w+) -->$', re.MULTILINE)


def with_results(text: str, results: Path, pictures: Path) -> str:
    """
    Return the text of a page with the tables that it marks, out of the folder `results`.

    Their pictures are copied into `pictures`, a folder beside the page. Raise DdctError for a
    table that no file has.
    """

    def shown(match: re.Match[str]) -> str:
        file, name = match[1], match[2]
        try:
            table = _tables(file, results)[name]
        except KeyError:
            raise DdctError(f'{results / file}.json has no table {name}: make site') from None
        rows = [[row[header] for header in table.headers] for row in table.rows]
        written = as_markdown(TextTable(table.title, table.headers, rows))
        picture = results / f'{name}.png'
        if not picture.is_file():
            return written
        pictures.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(picture, pictures / picture.name)
        return f'![{table.title}]({pictures.name}/{picture.name})\n\n{written}'

    return MARK.sub(shown, text)


@cache
def _tables(file: str, folder: Path) -> Mapping[str, WrittenTable]:
    """Return the tables of a file by name; raise DdctError where it cannot be read."""
    content: Any = read_json(FILES[file], folder / f'{file}.json', advice='make site')
    tables = content.tables if file == 'numbers' else content
    return {name: each.table if file == 'studies' else each for name, each in tables.items()}
