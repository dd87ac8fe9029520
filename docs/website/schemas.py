# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The schemas of what programs write as JSON: a table on the site, and the files that it links."""

import re
from pathlib import Path

from ddct_bringup.schemas import DOCUMENTS, SUFFIX, write_schemas
from ddct_plant.program.table import TextTable
from website.tables.markdown import as_markdown

_CODE = re.compile(r'(--[\w-]+|\w+\.json)')
"""Options and files, which stand as code."""


def schema_table(folder: Path) -> str:
    """Return the table as Markdown, and write its files into a folder beside the page."""
    write_schemas(folder)
    rows = [
        (_CODE.sub(r'`\1`', document.title), f'[{name}{SUFFIX}]({folder.name}/{name}{SUFFIX})')
        for name, document in DOCUMENTS.items()
    ]
    return as_markdown(TextTable('', ('what', 'schema'), rows))
