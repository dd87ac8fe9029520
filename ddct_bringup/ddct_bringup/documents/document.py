# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
A document: sections of tables, figures and notes, once for the terminal and for a page.

`terminal` prints a document and `page` makes the HTML of it; neither knows what it is about.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from markupsafe import Markup

from ddct_bringup.documents.chart import Chart
from ddct_plant.base.options import require_known
from ddct_plant.program.table import PURE, Weight, text_or_dash


@dataclass(frozen=True)
class Bar:
    """A share and its interval, 0 to 1, which a page draws below the text of a cell."""

    share: float
    interval: tuple[float, float] | None = None
    bad: bool = False
    """Whether it is a share of failures."""


@dataclass(frozen=True)
class Cell:
    """Value of a table with what belongs to it."""

    value: Any
    """A number, a text, or None for a dash."""
    form: str = ''
    """Format of the number, that of its column unless given."""
    unit: str = PURE
    """Unit of this value alone, or of the quantity that it names."""
    reason: str = ''
    """Reason of the dash, or a reservation about the value, which gets a star."""
    below: str = ''
    """What a page has in small letters below the value, and the terminal after it."""
    hint: str = ''
    """What a page shows where the pointer rests, such as a command."""
    alarming: bool = False
    """Whether it is bad news, which a page colours."""
    wall: bool = False
    """Whether it depends on the wall clock, so that the next run has another value."""
    bar: Bar | None = None

    @property
    def text(self) -> str:
        """Text of the value without its unit, or a dash."""
        if isinstance(self.value, str):
            return self.value
        return text_or_dash(self.value, self.form).replace('%', ' %')


@dataclass(frozen=True)
class Column:
    """Column of a table."""

    title: str
    unit: str = PURE
    """Unit, such as m/s^2, or PURE."""
    form: str = ''
    """Format of its numbers, such as '.3f', or '.1%' of shares; a cell may have its own."""
    number: bool = True
    """Whether it is aligned to the right and never wrapped."""
    weight: Weight = Weight.NEEDED
    """How much it matters where a terminal is narrow."""
    group: str = ''
    """Heading above it and its neighbours of the same group."""
    missing: str = ''
    """Reason of its dashes, unless a cell has its own."""
    symbols: bool = False
    """Whether its texts are names of quantities, such as w_sr, which a page typesets."""

    @property
    def heading(self) -> str:
        """Heading of a text table: its group, its title and its unit, a line each."""
        unit = '' if self.unit == PURE else self.unit
        return '\n'.join(filter(None, (self.group, self.title, unit)))

    def cell(self, value: Any) -> Cell:
        """Return a value as a cell, with the format and the reason that the column has for it."""
        cell = value if isinstance(value, Cell) else Cell(value)
        missing = self.missing if cell.value is None else ''
        return replace(cell, form=cell.form or self.form, reason=cell.reason or missing)


_Part = TypeVar('_Part', 'Table', 'Figure')
Row = Sequence[Any]
"""One value for each column: a Cell, a number, a text, or None for a dash."""


@dataclass(frozen=True)
class Table:
    """Rows of values under their columns."""

    title: str
    """Title; empty where that of the section says it."""
    columns: Sequence[Column]
    rows: Sequence[Row]
    emphasised: Sequence[int] = ()
    """Numbers of the rows that the document is about."""
    notes: Sequence[str] = ()
    """Sentences below the table."""

    @property
    def cells(self) -> list[list[Cell]]:
        """The cells of each row."""
        return [
            [column.cell(value) for column, value in zip(self.columns, row, strict=True)]
            for row in self.rows
        ]

    def _repr_mimebundle_(self, **_: object) -> Mapping[str, str]:
        """Return what a notebook shows."""
        from ddct_bringup.documents.notebook import table_forms

        return table_forms(self)


@dataclass(frozen=True)
class Drawing:
    """Chart with controls of its own: what a figure draws that `Chart` has no words for."""

    html: str
    figures: Mapping[str, Any]
    """Figures of Bokeh by their places in the HTML."""
    style: Markup
    script: Markup
    """Script that fills the figures on the event `drawn`, which has their views by place."""


@dataclass(frozen=True)
class Figure:
    """Chart of a page; the terminal has the numbers in tables."""

    title: str
    draw: Callable[[], Chart | Drawing]
    """Function that returns the chart, computed for a page alone."""
    words: str = ''
    """What it shows, for those who do not see it."""

    def _repr_mimebundle_(self, **_: object) -> Mapping[str, str | bytes]:
        """Return what a notebook shows."""
        from ddct_bringup.documents.notebook import chart_forms

        drawn = self.draw()
        if isinstance(drawn, Drawing):  # its script needs the page
            return {'text/plain': self.words}
        return chart_forms(drawn)


@dataclass(frozen=True)
class Note:
    """Sentence, for the terminal too, with a command that can be copied."""

    text: str
    command: str = ''
    """Line for a shell that follows the text."""
    after: str = ''
    """Text after the command."""
    page_only: bool = False


@dataclass(frozen=True)
class Remarks:
    """What to know before reading on, a line each; the terminal prints the lines."""

    title: str
    lines: Sequence[str]
    alarming: bool = False


@dataclass(frozen=True)
class Terms:
    """Meanings by term, or facts by name; the terminal has none of them."""

    entries: Mapping[str, str]
    facts: bool = False
    """Whether they are facts, whose texts stand as they are: not typeset, and lines kept."""
    commands: frozenset[str] = frozenset()
    """Names of the facts that are commands."""


@dataclass(frozen=True)
class Section:
    """Part of a document with a title."""

    title: str
    content: Sequence['Block']
    key: str = ''
    """Name for links, of a section that the navigation of a page names."""
    short: str = ''
    """Its name in the navigation, its title unless given."""
    folded: bool = False
    """Whether a page folds it, and the terminal leaves it out."""
    page_only: bool = False
    """Whether the terminal leaves it out."""


Block = Table | Figure | Note | Remarks | Terms | Section


@dataclass(frozen=True)
class Document:
    """What came out of many runs."""

    kind: str
    """What it is, such as 'Campaign'."""
    title: str
    lead: str
    """Sentence below the title."""
    content: Sequence[Block]
    complete: str = field(default='--json FILE', kw_only=True)
    """Output that has every number, where a terminal is too narrow."""

    def table(self, title: str) -> Table:
        """Return the table with this title, or in the section with it; raise ParameterError."""
        return _titled(title, dict(_parts(Table, self.content)))

    def figure(self, title: str) -> Figure:
        """Return the figure with this title, or in the section with it; raise ParameterError."""
        return _titled(title, dict(_parts(Figure, self.content)))


def _parts(
    kind: type[_Part], blocks: Sequence[Block], title: str = ''
) -> Iterator[tuple[str, _Part]]:
    """Yield the parts of a kind with their titles, or that of their section; the last first."""
    for block in reversed(blocks):
        if isinstance(block, Section):
            yield from _parts(kind, block.content, block.title)
        elif isinstance(block, kind):
            yield block.title or title, block


def _titled(title: str, parts: Mapping[str, _Part]) -> _Part:
    require_known([title], parts, 'title')
    return parts[title]


def given(*blocks: Block | None) -> list[Block]:
    """Return the blocks that are there: tables with rows, sections with content, and so on."""
    return [each for each in blocks if each is not None and not _is_empty(each)]


def _is_empty(block: Block) -> bool:
    if isinstance(block, Table):
        return not block.rows
    if isinstance(block, Section):
        return not block.content
    if isinstance(block, Remarks):
        return not block.lines
    if isinstance(block, Terms):
        return not block.entries
    return False
