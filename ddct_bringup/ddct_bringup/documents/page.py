# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Documents as pages: one HTML file without external resources, for light and dark, and paper."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from markupsafe import Markup, escape

from ddct_bringup.documents.bokeh_charts import PageCharts, library
from ddct_bringup.documents.chart import Chart
from ddct_bringup.documents.document import (
    Bar,
    Block,
    Cell,
    Column,
    Document,
    Drawing,
    Figure,
    Table,
)
from ddct_bringup.documents.page_parts import (
    DOCUMENTS,
    MARKER,
    json_data,
    page_part,
    page_template,
    symbols,
    unit_text,
)

_WORDS = 28
"""Number of characters from which the texts of a column wrap."""
_MINUS = re.compile(r'(?<![\w.])-(?=\d)')


def html_page(document: Document) -> str:
    """Return the HTML of a document."""
    charts, drawings = PageCharts(), list[Drawing]()

    def drawn(figure: Figure) -> Markup:
        """Return the element of a chart, whose figures and script the page gets."""
        chart = figure.draw()
        if isinstance(chart, Chart):
            return charts.add(chart, figure.words)
        for place, each in chart.figures.items():
            charts.add_figure(place, each)
        drawings.append(chart)
        return Markup(chart.html)

    def style() -> Markup:
        parts = (page_part(DOCUMENTS, name) for name in ('page.css', 'charts.css'))
        return Markup().join([*parts, *(each.style for each in drawings)])

    def script() -> Markup:
        parts = (page_part(DOCUMENTS, name) for name in ('page.js', 'charts.js', 'document.js'))
        bokeh = [library()] if charts else []
        return Markup().join([*bokeh, *(each.script for each in drawings), *parts])

    return page_template(DOCUMENTS, 'page.html.j2').render(
        marker=Markup(MARKER),
        document=document,
        kind_of=_kind_of,
        views=_TableView.of,
        drawn=drawn,
        style=style,
        script=script,
        data=lambda: json_data(charts.data),
    )


def chart_page(chart: Chart) -> str:
    """Return the HTML of a page with one chart."""
    return html_page(Document('Chart', chart.title, chart.conditions, [Figure('', lambda: chart)]))


def _kind_of(block: Block) -> str:
    return type(block).__name__


@dataclass(frozen=True)
class _RowView:
    """Row of a table as HTML."""

    cells: Sequence[Markup]
    classes: str


@dataclass(frozen=True)
class _TableView:
    """What the template shows of a table."""

    rows: Sequence[_RowView]
    groups: Mapping[int, int]
    """Number of columns of each group by the place of its first one."""
    notes: Sequence[str]

    @classmethod
    def of(cls, table: Table) -> '_TableView':
        """Return the view of a table."""
        groups = _groups(table.columns)
        cells = table.cells
        wraps = [_wraps(each) for each in zip(*cells, strict=True)]
        blocks = len({row[0].text for row in cells}) < len(cells)
        rows = [
            _RowView(
                [
                    _element(cell, column, place, wraps=wraps[place], first=place in groups)
                    for place, (cell, column) in enumerate(zip(row, table.columns, strict=True))
                ],
                ' '.join(
                    name
                    for name, holds in (
                        ('emphasised', number in table.emphasised),
                        ('next', blocks and number and row[0].text != cells[number - 1][0].text),
                    )
                    if holds
                ),
            )
            for number, row in enumerate(cells)
        ]
        return cls(rows, groups, notes_below(table))


def _groups(columns: Sequence[Column]) -> Mapping[int, int]:
    found = {}
    for name, group in groupby(enumerate(columns), key=lambda each: each[1].group):
        places = [place for place, _ in group]
        if name:
            found[places[0]] = len(places)
    return found


def _wraps(cells: Sequence[Cell]) -> bool:
    """Return whether a column has texts too long for one line."""
    return any(isinstance(cell.value, str) and len(cell.value) > _WORDS for cell in cells)


def _element(cell: Cell, column: Column, place: int, *, wraps: bool, first: bool) -> Markup:
    names = (
        ('num', column.number),
        ('words', wraps and not column.number),
        ('wall', cell.wall),
        ('first', first),
    )
    classes = ' '.join(name for name, holds in names if holds)
    attributes = Markup('')
    if classes:
        attributes += Markup(' class="{}"').format(classes)
    if hint := cell.hint or cell.reason:
        attributes += Markup(' title="{}"').format(hint)
    content = Markup().join(_content(cell, column))
    if place:
        return Markup('<td{}>{}</td>').format(attributes, content)
    return Markup('<th scope="row"{}>{}</th>').format(attributes, content)


def _content(cell: Cell, column: Column) -> Iterator[Markup]:
    value = cell.value
    if value is None:
        yield Markup('<span class="none">–</span>')
    else:
        text: Any = symbols(cell.text) if column.symbols else cell.text
        text = Markup(_MINUS.sub('−', str(escape(text))))
        if not isinstance(value, str):
            text = Markup('<data value="{}">{}</data>').format(value, text)
        yield Markup('<span class="alarming">{}</span>').format(text) if cell.alarming else text
        if unit := unit_text(cell.unit):
            yield Markup(' <small>{}</small>').format(unit)
        if cell.reason:
            yield Markup('<span class="star">*</span>')
    if cell.below:
        yield Markup('<small class="below">{}</small>').format(_MINUS.sub('−', cell.below))
    if cell.bar:
        yield _bar(cell.bar)


def _bar(bar: Bar) -> Markup:
    look = ' alarming' if bar.bad else ''
    drawn = Markup('<i class="bar{}" style="width:{:.1f}%"></i>').format(look, 100.0 * bar.share)
    if bar.interval:
        low, high = (100.0 * end for end in bar.interval)
        drawn += Markup('<i class="range" style="left:{:.1f}%;right:{:.1f}%"></i>').format(
            low, 100.0 - high
        )
    return Markup('<span class="track">{}</span>').format(drawn)


def notes_below(table: Table) -> list[str]:
    """Return the lines below a table: each reason of dashes and stars, then its notes."""
    found: dict[tuple[str, str], list[str]] = {}
    for row in table.cells:
        for cell, column in zip(row, table.columns, strict=True):
            if cell.reason:
                sign = '–' if cell.value is None else '*'
                titles = found.setdefault((sign, cell.reason), [])
                name = ' '.join(filter(None, (column.group, column.title)))
                if name not in titles:
                    titles.append(name)
    reasons = [
        f'{sign} in {", ".join(titles)}: {reason}' for (sign, reason), titles in found.items()
    ]
    return [*reasons, *table.notes]
