# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Gallery of the figures in the order of the thesis, with reasons for missing ones."""

import html
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

from ddct_bringup.reproduction.figures.thesis_figure import ThesisFigure, figure_order
from ddct_controllers.design.drawing.chart_style import INDEXED_SYMBOL

GENERATOR = '<meta name="generator" content="thesis figures">'
"""Tag of a page written by this program, which it may replace."""
CHAPTERS = {
    1: 'The transmission and its models',
    2: 'Loop shaping',
    3: 'H-infinity',
    4: 'Predictive control',
    5: 'Comparison',
}
"""Subjects of the thesis's chapters that have figures."""
_STYLE = """
:root { color-scheme: light dark; --paper: #fff; --ink: #1c1c1c; --faint: #5c5c5c;
  --line: #d8d8d8; --link: #005a8d; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #171717; --ink: #e4e4e4; --faint: #a6a6a6; --line: #3d3d3d; --link: #6db8e8; }
  img { filter: invert(0.91) hue-rotate(180deg); }
}
body { font: 1rem/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  max-width: 70rem; margin: 0 auto; padding: 1rem; }
header p { max-width: 46rem; }
h1 { font-size: 1.6rem; line-height: 1.2; }
h2 { font-size: 1.25rem; border-bottom: 1px solid var(--line); padding-bottom: .3rem;
  margin-top: 2.5rem; }
nav { display: flex; flex-wrap: wrap; gap: .4rem 1.2rem; }
a { color: var(--link); }
figure { margin: 1.5rem 0; }
img { display: block; width: 100%; height: auto; }
figcaption { overflow-wrap: break-word; }
figcaption b { display: block; margin: .4rem 0; }
.files { display: flex; gap: 1rem; margin-top: .5rem; font-size: .9rem; }
.absent { margin: .5rem 0; color: var(--faint); }
sub, sup { line-height: 0; font-size: .75em; }
@media (min-width: 52rem) {
  figure { display: grid; grid-template-columns: 8fr 5fr; gap: 1.5rem; }
}
@media print {
  :root { --paper: #fff; --ink: #000; --faint: #444; --line: #999; }
  body { max-width: none; padding: 0; font-size: 9pt; }
  nav, .files { display: none; }
  figure { display: grid; grid-template-columns: 12cm 1fr; gap: .5cm; break-inside: avoid;
    margin: .3cm 0; }
  img { filter: none; }
  h2, .absent { break-after: avoid; }
}
"""
"""Style of the page, for a light and a dark screen, a phone and paper."""
_INTRODUCTION = (
    'Drawn from the identified driveline and the calibrated scenario. Below each figure stands '
    'what agrees with the thesis and what does not. The thesis prints few numbers beside its '
    'figures; where it does, they stand next to ours.'
)


def file_name(number: str) -> str:
    """Return the name of a figure's files without the extension, such as figure_2_10."""
    return f'figure_{number.replace(".", "_")}'


def gallery_page(drawn: Mapping[ThesisFigure, str], not_drawn: Mapping[str, str]) -> str:
    """
    Return the HTML of the gallery; pictures are linked relative to it.

    `drawn` has a remark by figure, `not_drawn` a reason by number. The page shows the figures of
    both, in order.
    """
    entries = {figure.number: _picture(figure, remark) for figure, remark in drawn.items()}
    numbers = sorted((*entries, *not_drawn), key=figure_order)
    chapters = {
        chapter: list(found)
        for chapter, found in groupby(numbers, key=lambda number: figure_order(number)[0])
    }
    links = [
        f'<a href="#chapter-{chapter}">{chapter} {CHAPTERS[chapter]}</a>' for chapter in chapters
    ]
    sections = [
        part
        for chapter, found in chapters.items()
        for part in (
            f'<section id="chapter-{chapter}"><h2>Chapter {chapter}: {CHAPTERS[chapter]}</h2>',
            *_entries(found, entries, not_drawn),
            '</section>',
        )
    ]
    return '\n'.join(
        (
            '<!doctype html>',
            '<html lang="en"><head><meta charset="utf-8">',
            GENERATOR,
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f'<title>Figures of the thesis</title><style>{_STYLE}</style></head><body>',
            '<header><h1>Figures of the thesis, computed</h1>',
            f'<p>{len(drawn)} of {len(numbers)} figures are drawn. {_INTRODUCTION}</p>',
            f'<nav>{" ".join(links)}</nav></header>',
            '<main>',
            *sections,
            '</main></body></html>\n',
        )
    )


def _entries(
    numbers: Sequence[str], drawn: Mapping[str, str], not_drawn: Mapping[str, str]
) -> Iterator[str]:
    """Yield the HTML of figures in order; neighbours with the same reason share one line."""
    for reason, found in groupby(numbers, key=lambda number: not_drawn.get(number, '')):
        if not reason:
            yield from (drawn[number] for number in found)
            continue
        first, *others = found
        which = f'Figures {first} to {others[-1]}' if others else f'Figure {first}'
        yield f'<p class="absent"><b>{which}:</b> {_text(reason)}.</p>'


def _picture(figure: ThesisFigure, remark: str) -> str:
    name = file_name(figure.number)
    return (
        f'<figure id="figure-{figure.number}">'
        f'<a href="{name}.svg"><img src="{name}.png" alt="{html.escape(figure.heading)}" '
        'loading="lazy" width="1040" height="650"></a>'
        f'<figcaption><b>Figure {figure.number}: {_text(figure.title)}.</b> {_text(remark)}'
        f'<span class="files"><a href="{name}.svg">SVG</a> '
        f'<a href="{name}.csv">data as CSV</a></span>'
        '</figcaption></figure>'
    )


def _text(text: str) -> str:
    """Return text as HTML, symbols such as w_sr or W_s^-1 with their indices and powers."""
    return INDEXED_SYMBOL.sub(
        lambda symbol: (
            f'<i>{symbol[1]}</i><sub>{symbol[2]}</sub>'
            + (f'<sup>{symbol[3]}</sup>' if symbol[3] else '')
        ),
        html.escape(text),
    )
