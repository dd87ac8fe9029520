# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every link to a heading arrives, and the list of pages is complete."""

import re
from functools import cache
from pathlib import Path

from support.documented import PAGES, ROOT, links

READ = (*PAGES, ROOT / 'CONTRIBUTING.md', ROOT / 'QUALITY_DECLARATION.md', ROOT / 'SECURITY.md')
FENCED = re.compile(r'^(```+).*?^\1$', re.DOTALL | re.MULTILINE)
LINK = re.compile(r'\]\(([^)#\s]*)#([^)\s]+)\)')


@cache
def anchors(page: Path) -> set[str]:
    """Return what links to the headings of a page end in, as GitHub makes them."""
    text = FENCED.sub('', page.read_text(encoding='utf-8'))
    headings = [
        re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', each)
        for each in re.findall(r'^#+ (.*)$', text, re.MULTILINE)
    ]
    return {re.sub(r'[^\w\- ]', '', each.lower()).replace(' ', '-') for each in headings}


def test_links_to_headings_arrive() -> None:
    lost = [
        f'{page.relative_to(ROOT)}: {target}#{anchor}'
        for page in READ
        for target, anchor in LINK.findall(FENCED.sub('', page.read_text(encoding='utf-8')))
        if '://' not in target
        and anchor not in anchors((page.parent / target).resolve() if target else page)
    ]
    assert lost == []


def test_the_list_of_pages_has_every_page() -> None:
    listed = set(links(ROOT / 'docs' / 'README.md'))
    assert [str(page) for page in PAGES if page not in listed and page.parent.name != 'docs'] == []
