# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Pages can be read: what the reader can do stands first, no page is long, every link arrives."""

import re
from pathlib import Path

import pytest
from support.documented import PAGES, ROOT, links

READ = (*PAGES, ROOT / 'CONTRIBUTING.md')
MOST_WORDS = 1500
"""Of a page, its generated tables left out."""
GENERATED = re.compile(r'<!-- [\w-]+: \w+ -->\n.*?<!-- end -->', re.DOTALL)
FENCED = re.compile(r'^(```+).*?^\1$', re.DOTALL | re.MULTILINE)
LINK = re.compile(r'\]\(([^)#\s]*)#([^)\s]+)\)')
EACH_PAGE = pytest.mark.parametrize('page', READ, ids=lambda page: str(page.relative_to(ROOT)))


def paragraphs(page: Path) -> list[str]:
    return page.read_text(encoding='utf-8').split('\n\n')


def anchors(page: Path) -> set[str]:
    """Return what links to the headings of a page end in, as GitHub makes them."""
    text = FENCED.sub('', page.read_text(encoding='utf-8'))
    headings = [
        re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', each)
        for each in re.findall(r'^#+ (.*)$', text, re.MULTILINE)
    ]
    return {re.sub(r'[^\w\- ]', '', each.lower()).replace(' ', '-') for each in headings}


@EACH_PAGE
def test_it_begins_with_what_the_reader_can_do(page: Path) -> None:
    title, first, *_ = paragraphs(page)
    assert title.startswith('# ')
    assert re.match(r'(After this page|You can) ', first), first


@EACH_PAGE
def test_it_is_not_long(page: Path) -> None:
    words = len(GENERATED.sub('', page.read_text(encoding='utf-8')).split())
    assert words <= MOST_WORDS, f'{words} words: cut it, or part it'


@EACH_PAGE
def test_links_to_headings_arrive(page: Path) -> None:
    text = FENCED.sub('', page.read_text(encoding='utf-8'))
    lost = [
        f'{target}#{anchor}'
        for target, anchor in LINK.findall(text)
        if '://' not in target
        and anchor not in anchors((page.parent / target).resolve() if target else page)
    ]
    assert lost == []


def test_the_list_of_pages_has_every_page() -> None:
    listed = set(links(ROOT / 'docs' / 'README.md'))
    assert [str(page) for page in PAGES if page not in listed and page.parent.name != 'docs'] == []
