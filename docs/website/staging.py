# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The pages of the repository as Sphinx reads them: with an order, and links that stay inside."""

import re
import shutil
from pathlib import Path

from website.notebook_pages import notebook_page
from website.reference import write_reference
from website.results import with_results
from website.schemas import with_schemas

ROOT = Path(__file__).resolve().parents[2]
FRONT = 'README.md'
"""The page that becomes index.html."""
NOTEBOOK = '.ipynb'
ROOMS = {
    'Start': ('docs/README.md',),
    'Notebooks': (
        'docs/notebooks/thesis_in_one_hour.ipynb',
        'docs/notebooks/own_controller.ipynb',
        'docs/notebooks/campaign.ipynb',
    ),
    'Use': ('docs/use/*.md',),
    'Controllers': ('docs/controllers/*.md',),
    'Thesis': ('docs/thesis/*.md',),
    'Develop': ('docs/develop/*.md',),
    'Packages': ('ddct_*/README.md', 'ddct_*/CHANGELOG.md'),
    'Project': ('[A-QS-Z]*.md',),
}
"""Pages besides the front, by their heading in the sidebar."""
_LINK = re.compile(r'(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]+)(#[^)\s]*)?\)')
_FENCED = re.compile(r'(^```.*?^```)', re.DOTALL | re.MULTILINE)


def stage(folder: Path, results: Path) -> None:
    """
    Write the pages, the files that they link to, and the reference into a folder.

    `results` is a folder with the files of `website.results`.
    """
    folder.mkdir(parents=True)
    patterns = (pattern for room in ROOMS.values() for pattern in room)
    pages = [ROOT / FRONT, *(page for each in patterns for page in sorted(ROOT.glob(each)))]
    for page in pages:
        name = page.relative_to(ROOT)
        if page.suffix == NOTEBOOK:
            text = notebook_page(page, folder / name.parent / 'pictures')
            name = name.with_suffix('.md')
        else:
            text = page.read_text(encoding='utf-8')
        text = staged(page, text, folder)
        text = with_results(text, results, folder / name.parent / 'pictures')
        text = with_schemas(text, folder / name.parent / 'schemas')
        if name == Path(FRONT):
            name, text = Path('index.md'), text + _sidebar()
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


def _sidebar() -> str:
    """Return the hidden lists of pages by which Sphinx orders the sidebar."""
    lists = {
        heading: [str(Path(pattern).with_suffix('')) for pattern in patterns]
        for heading, patterns in ROOMS.items()
    }
    lists['Reference'] = ['reference/*']
    return ''.join(
        f'\n```{{toctree}}\n:hidden:\n:glob:\n:caption: {heading}\n\n'
        + '\n'.join(names)
        + '\n```\n'
        for heading, names in lists.items()
    )
