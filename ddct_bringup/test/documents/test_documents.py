# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One document gives the tables of a terminal and a page of the same numbers."""

import io
import re
import sys

import numpy as np
from refusals import refused

from ddct_bringup.documents.chart import Chart, Line, Panel
from ddct_bringup.documents.document import (
    Bar,
    Cell,
    Column,
    Document,
    Figure,
    Note,
    Remarks,
    Section,
    Table,
    Terms,
    given,
)
from ddct_bringup.documents.page import html_page
from ddct_bringup.documents.palette import looks
from ddct_bringup.documents.terminal import print_document
from ddct_plant.base.errors import ParameterError
from ddct_plant.program.table import Weight

COLUMNS = (
    Column('controller', number=False, weight=Weight.IDENTIFYING),
    Column('t_a', 's', '.2f', group='held out', missing='no run engaged'),
    Column('engaged', form='.1f', group='held out'),
)
ROWS = (
    ('pi', 1.25, Cell(90.0, below='of 10', bar=Bar(0.9, (0.6, 0.99)))),
    ('mpc_<3>', None, Cell(-12.5, alarming=True, reason='of one run alone')),
)


def never() -> Chart:
    raise AssertionError('the terminal draws no figure')


def document(draw=never) -> Document:
    return Document(
        'Test',
        'Test of <one>',
        'two controllers',
        [
            Remarks('Before reading', ['a line to know']),
            Section(
                'Times',
                [
                    Table('', COLUMNS, ROWS, emphasised=[1]),
                    Figure('t_a', draw, 'times'),
                    Note('Run it:', 'ddct run --x "a b"'),
                    Terms({'t_a': 'time of engagement'}),
                    Section('More', [Table('folded', COLUMNS, ROWS)], folded=True),
                ],
                key='times',
            ),
        ],
    )


def test_the_terminal_has_the_tables_with_reasons_remarks_and_commands() -> None:
    stream = io.StringIO()
    print_document(document(), stream)
    text = stream.getvalue()
    assert text.startswith('a line to know\n\nTimes\n')
    assert re.search(r'pi +1\.25 +90\.0; of 10', text)
    assert re.search(r'mpc_<3> +- +-12\.5\*', text)
    assert '-  no run engaged' in text
    assert '*  of one run alone' in text
    assert '  ddct run --x "a b"\n' in text
    assert 'folded' not in text
    assert 'time of engagement' not in text


def test_the_page_has_every_number_and_reason_and_escapes_what_it_shows() -> None:
    line = Line(np.arange(3.0), np.arange(3.0), looks(1)[0], '<pi>')
    page = html_page(document(lambda: Chart('t_a', (Panel((line,)),))))
    assert '<h1>Test of &lt;one&gt;</h1>' in page
    assert '<a href="#times">Times</a>' in page
    assert '<data value="1.25">1.25</data>' in page
    assert '<span class="alarming"><data value="-12.5">−12.5</data></span>' in page
    assert 'mpc_&lt;3&gt;' in page
    assert 't<sub>a</sub>: no run engaged' in page
    assert 'class="range" style="left:60.0%;right:1.0%"' in page
    assert page.count('<div class="chart" id="chart-0">') == 1
    assert '&lt;pi&gt;</span>' in page
    assert 'aria-label="times"' in page
    assert '<th scope="colgroup" colspan="2" class="of">held out</th>' in page
    assert '<details class="paper-too"><summary>More</summary>' in page
    assert '<code>ddct run --x &#34;a b&#34;</code>' in page


def test_wide_groups_of_columns_are_tables_of_their_own_on_a_terminal() -> None:
    numbers = [Column(name, form='d', group=of) for of in ('ours', 'theirs') for name in 'abcd']
    table = Table('Counts', (COLUMNS[0], *numbers), [('pi', *range(8))])
    stream = io.StringIO()
    print_document(Document('Test', 'Test', '', [table]), stream)
    ours, theirs = stream.getvalue().split('Counts, theirs\n')
    assert [line.split() for line in ours.splitlines()[:3]] == [
        *(['Counts,', 'ours'], ['controller', *'abcd'], ['pi', *'0123']),
    ]
    assert theirs.splitlines()[1].split() == ['pi', *'4567']


def test_blocks_without_content_are_left_out() -> None:
    assert given(None, Table('', COLUMNS, []), Remarks('x', []), Section('y', [])) == []


def test_a_notebook_has_the_tables_and_figures_of_the_document_by_their_titles() -> None:
    def drawn() -> Chart:
        x = np.array([0.0, 1.0])
        return Chart('over time', (Panel((Line(x, x, looks(1)[0], 'pi'),)),))

    given_by = document(drawn)
    forms = given_by.table('Times')._repr_mimebundle_()
    assert '<td>mpc_&lt;3&gt;</td><td>-</td><td>-12.5*</td>' in forms['text/html']
    assert '<p>* in held out engaged: of one run alone</p>' in forms['text/html']
    assert re.search(r'pi +1\.25 +90\.0; of 10', forms['text/plain'])
    assert given_by.table('folded').columns == COLUMNS
    picture = given_by.figure('t_a')._repr_mimebundle_()
    assert picture['image/png'][:4] == b'\x89PNG'
    assert picture['text/plain'] == 'over time'
    with refused(ParameterError, 'Time'):
        given_by.table('Time')


def test_a_page_without_a_chart_does_without_bokeh(monkeypatch):
    monkeypatch.setitem(sys.modules, 'bokeh.document', None)
    page = html_page(Document('Kind', 'title', 'lead', [Note('text')]))
    assert '"roots":{}' in page
