# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every link leads to a file and to a heading, and every page is found."""

import re
from functools import cache
from pathlib import Path

from support.documented import PAGES, ROOT, links

READ = (*PAGES, *sorted(ROOT.glob('[A-QS-Z]*.md')), *sorted(ROOT.glob('ddct_*/*.md')))
FENCED = re.compile(r'^(```+).*?^\1$', re.DOTALL | re.MULTILINE)
LINK = re.compile(r'\]\(([^)#\s]*)#([^)\s]+)\)')
CLICKS = 3


@cache
def anchors(page: Path) -> set[str]:
    """Return what links to the headings of a page end in, as GitHub makes them."""
    text = FENCED.sub('', page.read_text(encoding='utf-8'))
    headings = [
        re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', each)
        for each in re.findall(r'^#+ (.*)$', text, re.MULTILINE)
    ]
    return {re.sub(r'[^\w\- ]', '', each.lower()).replace(' ', '-') for each in headings}


def test_links_lead_to_files() -> None:
    lost = {str(page): [each for each in links(page) if not each.exists()] for page in READ}
    assert {page: targets for page, targets in lost.items() if targets} == {}


def test_links_to_headings_arrive() -> None:
    lost = [
        f'{page.relative_to(ROOT)}: {target}#{anchor}'
        for page in READ
        for target, anchor in LINK.findall(FENCED.sub('', page.read_text(encoding='utf-8')))
        if '://' not in target
        and anchor not in anchors((page.parent / target).resolve() if target else page)
    ]
    assert lost == []


def test_every_page_is_three_clicks_from_the_top() -> None:
    found = {PAGES[0]}
    for _ in range(CLICKS):
        found |= {target for page in found if page.suffix == '.md' for target in links(page)}
    assert [str(page) for page in PAGES if page not in found] == []


def test_the_list_of_pages_has_every_page() -> None:
    listed = set(links(ROOT / 'docs' / 'README.md'))
    assert [str(page) for page in PAGES if page not in listed and page.parent.name != 'docs'] == []
