# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quantities, and tables of them; `printed_table` prints a table."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import IntEnum
from typing import Any, Generic, TypeVar

from ddct_plant.base.errors import printable

PURE = '1'
"""Unit of a pure number."""
UNDEFINED = '-'
"""Text of an undefined value."""


class Weight(IntEnum):
    """How much a column matters where a table is wider than its output."""

    DETAIL = 0
    """Left out first."""
    USEFUL = 1
    """Left out where it does not fit."""
    NEEDED = 2
    """Always shown, in a further block where it does not fit."""
    IDENTIFYING = 3
    """Needed to know which row it is: shown in every block."""


@dataclass(frozen=True)
class Quantity:
    """A number of a run, described once for terminal, JSON, documentation pages and the report."""

    key: str
    """Key in JSON."""
    symbol: str
    """Symbol in tables; an underscore begins its index."""
    unit: str
    """Unit, such as m/s^2, or PURE."""
    form: str
    """Format of the number, such as '.3f'."""
    meaning: str
    """Meaning in a few words."""
    undefined: str = ''
    """Condition under which it has no value."""

    @property
    def heading(self) -> str:
        """Symbol and unit, as the heading of a column."""
        return self.symbol if self.unit == PURE else f'{self.symbol} {self.unit}'

    def cell(self, values: Mapping[str, object]) -> str:
        """Return the text of this quantity's value, from values by key."""
        return text_or_dash(values[self.key], self.form)


Row = TypeVar('Row')


@dataclass(frozen=True)
class TextColumn(Generic[Row]):
    """Column of a table: its heading, and the value and text of each row."""

    heading: str
    """Heading; a newline separates name and unit."""
    form: str
    """Format of the value, such as '.3f'."""
    value: Callable[[Row], Any]
    """Function from a row to its value; None, shown as a dash, where it is undefined."""
    number: bool = True
    """Whether the column is aligned to the right and its values are never wrapped."""
    undefined: Callable[[Row], str] = lambda row: ''
    """Function from a row to the reason for which its value is undefined."""
    remark: Callable[[Row], str] = lambda row: ''
    """Function from a row to a reservation about its value, shown as a star; empty for none."""
    weight: Weight = Weight.NEEDED

    def text(self, row: Row) -> str:
        """Return the text of a row's value."""
        return text_or_dash(self.value(row), self.form)

    def cell(self, row: Row) -> str:
        """Return the text of a row's cell."""
        return printable(self.text(row))

    def reason(self, row: Row) -> str:
        """Return the reason of a row's dash or star, empty for none."""
        return self.undefined(row) if self.value(row) is None else self.remark(row)


@dataclass(frozen=True)
class WrittenTable:
    """A table as JSON has it."""

    title: str
    headers: Sequence[str]
    rows: Sequence[Mapping[str, str]]
    """Cells by header."""


@dataclass(frozen=True)
class TextTable:
    """Rows of text, one cell per header, the same for the terminal and a documentation page."""

    title: str
    headers: Sequence[str]
    rows: Sequence[Sequence[str]]
    numbers: Sequence[bool] = field(default=(), kw_only=True)
    """
    Whether each column, from the first on, is aligned to the right and never wrapped; of others,
    those that have nothing but numbers are.
    """
    weights: Sequence[Weight] = field(default=(Weight.IDENTIFYING,), kw_only=True)
    """Weight of each column, from the first on; those of the others are NEEDED."""
    reasons: Mapping[tuple[int, int], str] = field(default_factory=dict, kw_only=True)
    """Reason by row and column of each dash, and of each other cell that gets a star."""
    warnings: Sequence[str] = field(default=(), kw_only=True)
    """Sentences below the table that come before the reasons of its dashes and stars."""
    notes: Sequence[str] = field(default=(), kw_only=True)
    """Sentences after them, the most important ones first."""
    complete: str = field(default='', kw_only=True)
    """Output that has every column and reason, such as '--json FILE'; empty for none."""

    @property
    def written(self) -> WrittenTable:
        """The table as JSON has it."""
        rows = [dict(zip(self.headers, row, strict=True)) for row in self.rows]
        return WrittenTable(self.title, self.headers, rows)


def table_of(
    title: str,
    columns: Sequence[TextColumn[Row]],
    rows: Iterable[Row],
    complete: str = '',
    notes: Sequence[str] = (),
) -> TextTable:
    """Return the table of columns over rows; `complete` names an output with all of it."""
    rows = list(rows)
    return TextTable(
        title,
        [column.heading for column in columns],
        [[column.cell(row) for column in columns] for row in rows],
        numbers=[column.number for column in columns],
        weights=[column.weight for column in columns],
        reasons={
            (line, place): reason
            for line, row in enumerate(rows)
            for place, column in enumerate(columns)
            if (reason := column.reason(row))
        },
        notes=notes,
        complete=complete,
    )


AnyTable = TypeVar('AnyTable', bound=TextTable)


def with_reasons(table: AnyTable, reason: Callable[[str, Sequence[str]], str]) -> AnyTable:
    """Return a table with the reason of every dash, a function of its header and its row."""
    found = {
        (line, place): reason(table.headers[place], row)
        for line, row in enumerate(table.rows)
        for place, cell in enumerate(row)
        if cell == UNDEFINED
    }
    return replace(table, reasons={**table.reasons, **found})


def text_or_dash(value: object, form: str) -> str:
    """Return a value in a format, or a dash for None: an undefined value or no limit."""
    return UNDEFINED if value is None else format(value, form)
