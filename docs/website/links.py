# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Links, anchors and pictures of a built site."""

from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """What a page of the site links to, the anchors that it has, and its pictures."""

    def __init__(self, file: Path) -> None:
        """Read the page."""
        super().__init__()
        self.targets: list[str] = []
        """Addresses of links, pictures, styles and scripts."""
        self.anchors: set[str] = set()
        """Places in the page that a link may name."""
        self.without_text: list[str] = []
        """Pictures without alternative text."""
        self.fetched: list[str] = []
        """Addresses in the web that a browser fetches to show the page."""
        self.feed(file.read_text(encoding='utf-8'))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keep the addresses and the anchor of an element."""
        given = {name: value or '' for name, value in attrs}
        self.targets += [given[name] for name in ('href', 'src') if given.get(name)]
        self.anchors |= {given[name] for name in ('id', 'name') if given.get(name)}
        fetches = tag in ('img', 'script') or given.get('rel') == 'stylesheet'
        self.fetched += [each for each in self.targets[-1:] if fetches and '://' in each]
        if tag == 'img' and not given.get('alt'):
            self.without_text.append(given.get('src', ''))


class Fault(NamedTuple):
    """A link that leads nowhere, or another fault of a page."""

    page: str
    what: str


def faults(site: Path) -> Iterator[Fault]:
    """Yield links to missing files or places, pictures without text, and what is fetched."""
    pages = {file.resolve(): Page(file) for file in site.rglob('*.html')}
    for file, page in pages.items():
        name = str(file.relative_to(site.resolve()))
        for picture in page.without_text:
            yield Fault(name, f'the picture {picture} has no alternative text')
        for target in page.fetched:
            yield Fault(name, f'the page does not open offline: it fetches {target}')
        for target in page.targets:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            path = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            if not path.is_file():
                yield Fault(name, f'{target} leads to no file')
                continue
            anchors = pages[path].anchors if path in pages else {unquote(parts.fragment)}
            if parts.fragment and unquote(parts.fragment) not in anchors:
                yield Fault(name, f'{target} leads to no place in its page')
