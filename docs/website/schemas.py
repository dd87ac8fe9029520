# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The schemas of what programs write as JSON: a table on the site, and the files that it links."""

import re
from pathlib import Path

from generator.markdown import as_markdown

from ddct_bringup.schemas import DOCUMENTS, SUFFIX, write_schemas
from ddct_plant.program.table import TextTable

_CODE = re.compile(r'(--[\w-]+|\w+\.json)')
"""Options and files, which stand as code."""
MARK = '<!-- schemas -->'
"""Line of a page where the site has the table."""


def with_schemas(text: str, folder: Path) -> str:
    """Return the text of a page with the table, if it marks one; `folder` is beside the page."""
    if MARK not in text:
        return text
    write_schemas(folder)
    rows = [
        (_CODE.sub(r'`\1`', document.title), f'[{name}{SUFFIX}]({folder.name}/{name}{SUFFIX})')
        for name, document in DOCUMENTS.items()
    ]
    return text.replace(MARK, as_markdown(TextTable('', ('what', 'schema'), rows)))
