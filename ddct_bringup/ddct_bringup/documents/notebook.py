# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables and figures of documents as a notebook shows them; it asks each object for its forms."""

import io
from collections.abc import Iterator, Mapping, Sequence

from markupsafe import Markup

from ddct_bringup.documents.chart import Chart
from ddct_bringup.documents.chart_files import matplotlib_figure
from ddct_bringup.documents.document import Table
from ddct_bringup.documents.page import notes_below
from ddct_bringup.documents.terminal import text_table
from ddct_plant.program.printed_table import print_table
from ddct_plant.program.table import UNDEFINED

_PIXELS_PER_IN = 130.0


def table_forms(table: Table) -> Mapping[str, str]:
    """Return a table by media type: HTML in the style of the notebook, and the terminal's text."""
    text = io.StringIO()
    print_table(text_table(table), text)
    return {'text/html': str(Markup('\n').join(_html(table))), 'text/plain': text.getvalue()}


def chart_forms(chart: Chart) -> Mapping[str, str | bytes]:
    """Return a chart by media type: a picture, and its title."""
    picture = io.BytesIO()
    matplotlib_figure(chart).savefig(picture, format='png', dpi=_PIXELS_PER_IN)
    return {'image/png': picture.getvalue(), 'text/plain': chart.title}


def _html(table: Table) -> Iterator[Markup]:
    texts = text_table(table)
    if table.title:
        yield Markup('<p><b>{}</b></p>').format(table.title)
    yield Markup('<table><thead>')
    yield _row('th', [Markup('<br>').join(each.split('\n')) for each in texts.headers])
    yield Markup('</thead><tbody>')
    for number, row in enumerate(texts.rows):
        stars = [_star(cell, (number, place) in texts.reasons) for place, cell in enumerate(row)]
        yield _row('td', stars)
    yield Markup('</tbody></table>')
    for line in notes_below(table):
        yield Markup('<p>{}</p>').format(line)


def _star(text: str, has_reason: bool) -> str:
    """Return the text of a cell, with a star where there is a reservation about the value."""
    return f'{text}*' if has_reason and text != UNDEFINED else text


def _row(tag: str, cells: Sequence[str]) -> Markup:
    inside = Markup().join(Markup(f'<{tag}>{{}}</{tag}>').format(each) for each in cells)
    return Markup('<tr>{}</tr>').format(inside)
