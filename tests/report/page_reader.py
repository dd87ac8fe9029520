"""Read a report's page as a browser without JavaScript would."""

from html.parser import HTMLParser


class PageReader(HTMLParser):
    """Collects the text that a reader sees, the metrics, and whatever would load something."""

    def __init__(self, html: str) -> None:
        """Read the page."""
        super().__init__()
        self.text = ''
        self.metrics: list[tuple[str, float | None, str]] = []
        """(name in scores.json, exact value or None, text shown) in the order of the page."""
        self.links: list[str] = []
        """Every address in an attribute."""
        self.styles = ''
        self._hidden: list[str] = []
        self._metric: str | None = None
        self._value: float | None = None
        self._shown = ''
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what the tag carries."""
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
        """Close what the tag has opened."""
        if tag in ('script', 'style'):
            self._hidden.pop()
        if tag == 'td' and self._metric:
            self.metrics.append((self._metric, self._value, self._shown.strip()))
            self._metric = None

    def handle_data(self, data: str) -> None:
        """Keep visible text, and styles apart from it."""
        if not self._hidden:
            self.text += data
            self._shown += data
        elif self._hidden[-1] == 'style':
            self.styles += data
