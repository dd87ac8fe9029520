"""What shows the figures: a gallery beside the pictures, and the tables of docs/figures.md."""

import html
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ddct_controllers.design.thesis_figures.thesis_figure import ThesisFigure

GENERATOR = '<meta name="generator" content="design figures">'
"""Marks a page as written here, so that it may be replaced."""
_INTRODUCTION = (
    'The figures of the thesis that can be computed, drawn from the identified driveline and the '
    'calibrated scenario. The thesis prints few numbers beside its figures: where it does, they '
    'stand here next to ours.'
)
_STYLE = (
    'body{font-family:sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#111}'
    'figure{margin:2.5rem 0}img{max-width:100%;height:auto}'
    'figcaption{line-height:1.4}td,th{text-align:left;padding:.15rem .8rem .15rem 0}'
)


@dataclass(frozen=True)
class DrawnFigure:
    """A figure with what its drawing found out."""

    figure: ThesisFigure
    remark: str


@dataclass(frozen=True)
class FigureTable:
    """A table of the documentation."""

    headers: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def picture_name(number: str) -> str:
    """Return the file name of a figure, such as figure_2_10.png."""
    return f'figure_{number.replace(".", "_")}.png'


def gallery_page(drawn: Sequence[DrawnFigure], not_drawn: Mapping[str, str]) -> str:
    """Return the HTML of the gallery; pictures are linked relative to it."""
    rows = [
        f'<tr><td>{numbers}</td><td>{html.escape(reason)}</td></tr>'
        for numbers, reason in _by_reason(not_drawn)
    ]
    table = ['<h2>Not drawn</h2>', '<table>', *rows, '</table>'] if rows else []
    return '\n'.join(
        (
            '<!doctype html>',
            '<html lang="en"><head><meta charset="utf-8">',
            GENERATOR,
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f'<title>Figures of the thesis</title><style>{_STYLE}</style></head><body>',
            '<h1>Figures of the thesis, computed</h1>',
            f'<p>{_INTRODUCTION}</p>',
            *(_picture(entry) for entry in drawn),
            *table,
            '</body></html>\n',
        )
    )


def page_tables(
    drawn: Sequence[DrawnFigure], not_drawn: Mapping[str, str]
) -> dict[str, FigureTable]:
    """Return the tables of docs/figures.md by name."""
    rows = tuple((entry.figure.number, entry.figure.title, entry.remark) for entry in drawn)
    return {
        'drawn': FigureTable(('figure', 'shows', 'what agrees, what does not'), rows),
        'not_drawn': FigureTable(('figures', 'reason'), _by_reason(not_drawn)),
    }


def _picture(entry: DrawnFigure) -> str:
    name, heading = picture_name(entry.figure.number), html.escape(entry.figure.heading)
    return (
        f'<figure id="f{entry.figure.number}"><img src="{name}" alt="{heading}" loading="lazy">'
        f'<figcaption><b>{heading}.</b> {html.escape(entry.remark)}</figcaption></figure>'
    )


def _by_reason(not_drawn: Mapping[str, str]) -> tuple[tuple[str, str], ...]:
    """Return the numbers that share a reason, and the reason."""
    shared: dict[str, list[str]] = {}
    for number, reason in not_drawn.items():
        shared.setdefault(reason, []).append(number)
    return tuple((', '.join(numbers), reason) for reason, numbers in shared.items())
