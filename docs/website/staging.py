# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The pages of the repository as Sphinx reads them: with an order, and links that stay inside."""

import re
import shutil
from collections.abc import Mapping
from pathlib import Path

from website.notebook_pages import notebook_page
from website.reference import write_reference

ROOT = Path(__file__).resolve().parents[2]
FRONT = 'README.md'
"""The page that becomes index.html."""
NOTEBOOK = '.ipynb'
LIST = 'docs/README.md'
"""The list of pages: it comes first in the sidebar, which has its headings and its order."""
_LINK = re.compile(r'(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]+)(#[^)\s]*)?\)')
_ROOM = re.compile(r'^## (.+)\n((?:(?!## ).*\n?)*)', re.MULTILINE)
_FENCED = re.compile(r'(^```.*?^```)', re.DOTALL | re.MULTILINE)


def stage(folder: Path) -> None:
    """Write the pages, the files that they link to, and the reference into a folder."""
    folder.mkdir(parents=True)
    rooms = listed()
    pages = (page for room in rooms.values() for page in room)
    for page in (ROOT / FRONT, ROOT / LIST, *pages):
        name = page.relative_to(ROOT)
        if page.suffix == NOTEBOOK:
            text = notebook_page(page, folder / name.parent / 'pictures')
            name = name.with_suffix('.md')
        else:
            text = page.read_text(encoding='utf-8')
        text = staged(page, text, folder)
        if name == Path(FRONT):
            name, text = Path('index.md'), text + _sidebar(rooms)
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding='utf-8')
    write_reference(folder / 'reference')


def staged(page: Path, text: str, folder: Path) -> str:
    """
    Return the text of a page with links that lead to a page of the site or to a copied file.

    A link to another file of the repository leads to its copy in the folder. A link to a folder
    becomes its text, as a site has no folders to look into. Code is left alone.
    """

    def inside(match: re.Match[str]) -> str:
        mark, text, target, anchor = match[1], match[2], match[3], match[4] or ''
        if '://' in target or target.startswith('mailto:'):
            return match[0]
        file = (page.parent / target).resolve()
        if file.is_dir():
            return text
        if file == ROOT / FRONT:
            front = '../' * (len(page.relative_to(ROOT).parts) - 1) + 'index.md'
            return f'{mark}[{text}]({front}{anchor})'
        if file.suffix == NOTEBOOK:
            return f'{mark}[{text}]({target.removesuffix(NOTEBOOK)}.md{anchor})'
        copy = folder / file.relative_to(ROOT)
        if file.suffix != '.md' and not copy.is_file():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, copy)
        return match[0]

    fences = _FENCED.split(text)
    return ''.join(
        part if number % 2 else _LINK.sub(inside, part) for number, part in enumerate(fences)
    )


def listed() -> dict[str, list[Path]]:
    """Return the pages by heading of the list: those that the first cells of its rows link to."""
    rooms: dict[str, list[Path]] = {}
    for heading, rows in _ROOM.findall((ROOT / LIST).read_text(encoding='utf-8')):
        cells = ' '.join(row.split(' | ')[0] for row in rows.splitlines() if row[:3] == '| [')
        rooms[heading] = [(ROOT / LIST).parent / match[3] for match in _LINK.finditer(cells)]
    return {heading: [page.resolve() for page in pages] for heading, pages in rooms.items()}


def _sidebar(rooms: Mapping[str, list[Path]]) -> str:
    """Return the hidden lists of pages by which Sphinx orders the sidebar."""
    lists = {
        heading: [str(page.relative_to(ROOT).with_suffix('')) for page in pages]
        for heading, pages in rooms.items()
    }
    lists = {'Pages': [str(Path(LIST).with_suffix(''))], **lists, 'Reference': ['reference/*']}
    return ''.join(
        f'\n```{{toctree}}\n:hidden:\n:glob:\n:caption: {heading}\n\n'
        + '\n'.join(names)
        + '\n```\n'
        for heading, names in lists.items()
    )
