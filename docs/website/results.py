# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Tables of results that only the site has, from the files that programs write.

A page has the mark `<!-- table: FILE NAME -->` on a line of its own, where the site has the table
NAME of FILE.json. `make site` makes the files. A picture NAME.png beside them goes above its
table.
"""

import json
import re
import shutil
from functools import cache
from pathlib import Path
from typing import TypedDict

from generator.markdown import as_markdown

from ddct_plant.base.errors import DdctError
from ddct_plant.program.table import Table

FILES = ('numbers', 'benchmark', 'studies')
"""Names of the files, each with `.json`."""
MARK = re.compile(r'^<!-- table: (\w+) (\w+) -->$', re.MULTILINE)


class WrittenTable(TypedDict):
    """A table as `Table.as_dict` writes it."""

    title: str
    headers: list[str]
    rows: list[dict[str, str]]


def with_results(text: str, results: Path, pictures: Path) -> str:
    """
    Return the text of a page with the tables that it marks, out of the folder `results`.

    Their pictures are copied into `pictures`, a folder beside the page. Raise DdctError for a
    table that no file has.
    """

    def shown(match: re.Match[str]) -> str:
        file, name = match[1], match[2]
        try:
            table = _tables(results / f'{file}.json')[name]
        except KeyError:
            raise DdctError(f'{results / file}.json has no table {name}: make site') from None
        rows = [[row[header] for header in table['headers']] for row in table['rows']]
        written = as_markdown(Table(table['title'], table['headers'], rows))
        picture = results / f'{name}.png'
        if not picture.is_file():
            return written
        pictures.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(picture, pictures / picture.name)
        return f'![{table["title"]}]({pictures.name}/{picture.name})\n\n{written}'

    return MARK.sub(shown, text)


@cache
def _tables(file: Path) -> dict[str, WrittenTable]:
    """Return the tables of a file by name; `numbers.json` has them beside the numbers."""
    try:
        content = json.loads(file.read_text(encoding='utf-8'))
    except OSError as error:
        raise DdctError(f'{file} cannot be read ({error.strerror}): make site') from error
    tables: dict[str, WrittenTable] = content.get('tables', content)
    return tables
