# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Read a report's page as a browser without JavaScript would."""

from html.parser import HTMLParser


class PageReader(HTMLParser):
    """Collects the visible text, the metrics, and every address that would be loaded."""

    def __init__(self, html: str) -> None:
        """Read the page."""
        super().__init__()
        self.text = ''
        self.metrics: list[tuple[str, float | None, str]] = []
        """
        Triples (name in scores.json, exact value or None, visible text) in the order of the page.
        """
        self.links: list[str] = []
        """Addresses in attributes."""
        self.styles = ''
        self._hidden: list[str] = []
        self._metric: str | None = None
        self._value: float | None = None
        self._shown = ''
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Store metrics and addresses of the tag."""
        attributes = dict(attrs)
        self.links += [
            value or '' for name, value in attrs if name in ('src', 'href', 'action', 'srcset')
        ]
        if tag in ('script', 'style'):
            self._hidden.append(tag)
        if tag == 'td':
            self._metric = attributes.get('data-metric')
            self._value, self._shown = None, ''
        if tag == 'data':
            self._value = float(attributes['value'] or '')

    def handle_endtag(self, tag: str) -> None:
        """Close the element that the tag has opened."""
        if tag in ('script', 'style'):
            self._hidden.pop()
        if tag == 'td' and self._metric:
            self.metrics.append((self._metric, self._value, self._shown.strip()))
            self._metric = None

    def handle_data(self, data: str) -> None:
        """Store visible text, and styles separately."""
        if not self._hidden:
            self.text += data
            self._shown += data
        elif self._hidden[-1] == 'style':
            self.styles += data
