# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A notebook as a page of the site: its texts, its code, and the outputs that it keeps."""

import base64
import json
import re
from collections.abc import Iterator, Mapping
from html import escape
from pathlib import Path
from typing import Any

_STYLE = re.compile(r'<style.*?</style>\s*', re.DOTALL)
"""Style that pandas puts before each table; the site has its own."""


def notebook_page(path: Path, pictures: Path) -> str:
    """
    Return a notebook as Markdown; its pictures are written into a folder beside the page.

    A picture has the alternative text of its cell, `alt` in the metadata.
    """
    notebook = json.loads(path.read_text(encoding='utf-8'))
    parts: list[str] = []
    for number, cell in enumerate(notebook['cells']):
        source = ''.join(cell['source'])
        if cell['cell_type'] == 'markdown':
            parts.append(source)
            continue
        parts.append(f'```python\n{source}\n```')
        name = f'{path.stem}_{number}'
        parts += _outputs(cell, pictures, name)
    where = f'This page is `docs/notebooks/{path.name}` with the outputs that it keeps.'
    return '\n\n'.join((parts[0], where, *parts[1:])) + '\n'


def _outputs(cell: Mapping[str, Any], pictures: Path, name: str) -> Iterator[str]:
    """Yield each output of a cell as Markdown or HTML without empty lines."""
    for place, output in enumerate(cell['outputs']):
        data = {kind: ''.join(text) for kind, text in output.get('data', {}).items()}
        if 'image/png' in data:
            file = pictures / f'{name}_{place}.png'
            pictures.mkdir(parents=True, exist_ok=True)
            file.write_bytes(base64.b64decode(data['image/png']))
            yield f'![{cell["metadata"]["alt"]}]({pictures.name}/{file.name})'
        elif 'text/html' in data:
            yield f'<div class="output">{_STYLE.sub("", data["text/html"])}</div>'
        elif 'text/markdown' in data:
            yield data['text/markdown']
        else:
            text = data.get('text/plain') or ''.join(output['text'])
            yield f'<div class="output"><pre>{escape(text.rstrip())}</pre></div>'
