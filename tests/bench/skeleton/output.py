# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The table of a bench, at most 80 columns wide, and its progress on standard error."""

import sys
import textwrap
import time
from collections.abc import Iterable, Sequence
from typing import TextIO

from bench.skeleton.comparison import Comparison
from bench.skeleton.rounds import BAD, FAILED, NOT_MEASURED, Result

WIDTH = 80
_NAME = 43
_HEAD = f'{"ratio":>7} {"rounds":>14} {"bound":>5}  '


def text_of(ratio: float) -> str:
    """Return a ratio with three significant digits; below 0.1 with two."""
    return f'{ratio:.0f}' if ratio >= 100.0 else f'{ratio:#.{3 if ratio >= 0.1 else 2}g}'


def list_of(comparisons: Iterable[Comparison]) -> list[str]:
    """Return the lines that list comparisons: name and reference, then what the cost is."""
    return [
        line
        for each in comparisons
        for line in (
            *textwrap.wrap(f'{each.name}, beside {each.reference}', WIDTH),
            *_wrapped(each.meaning, indent='    '),
        )
    ]


def table_of(results: Sequence[Result]) -> str:
    """Return the table: figures by reference, then what was not measured or failed, and why."""
    lines: list[str] = []
    measured = [result for result in results if result.ratios]
    for reference in dict.fromkeys(result.reference for result in measured):
        title = f'Beside {reference}'
        above = _wrapped(title, indent='') if len(title) >= _NAME else []
        lines += ['', *above, f'{"" if above else title:{_NAME}}{_HEAD}'.rstrip()]
        for result in measured:
            if result.reference == reference:
                lines += _row(result)
    for outcome in (NOT_MEASURED, FAILED):
        missing = [result for result in results if result.outcome == outcome]
        for reason in dict.fromkeys(result.reason for result in missing):
            lines += ['', *_wrapped(f'{outcome.capitalize()}: {reason}', indent='')]
            for result in missing:
                if result.reason == reason:
                    lines += _wrapped(f'{result.name}, beside {result.reference}')
    lines += ['', *_wrapped(_summary(results), indent='')]
    return '\n'.join(lines[1:])


def _row(result: Result) -> list[str]:
    spread = f'{text_of(min(result.ratios))}-{text_of(max(result.ratios))}'
    bound = '' if result.bound is None else text_of(result.bound)
    numbers = f'{text_of(result.median):>7} {spread:>14} {bound:>5}  {result.outcome}'.rstrip()
    *above, last = textwrap.wrap(result.name, _NAME - 3, subsequent_indent='  ')
    return [*(f'  {line}' for line in above), f'  {last:{_NAME - 2}}{numbers}']


def _wrapped(text: str, indent: str = '  ') -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent + '  ')


def _summary(results: Iterable[Result]) -> str:
    bad = [result.name for result in results if result.outcome in BAD]
    if bad:
        return f'Beyond its bound in every round, or failed: {"; ".join(bad)}.'
    return 'No figure is beyond its bound in every round.'


class Progress:
    """Progress of the comparisons: on a terminal one line that changes, elsewhere their ends."""

    def __init__(self, total: int, rounds: int, stream: TextIO = sys.stderr) -> None:
        self._total, self._rounds, self._stream = total, rounds, stream
        self._terminal = stream.isatty()
        self._started = time.monotonic()

    def during(self, number: int, name: str, done: int) -> None:
        """Show on a terminal how many rounds of comparison `number`, from 1 on, are done."""
        if self._terminal:
            line = f'[{number}/{self._total}] {name}: round {done + 1} of {self._rounds}'
            self._stream.write(f'\r\x1b[K{line[: WIDTH - 1]}')
            self._stream.flush()

    def after(self, number: int, results: Iterable[Result]) -> None:
        """Print the results of a comparison, with the time in s since the start of the bench."""
        start = '\r\x1b[K' if self._terminal else ''
        elapsed = time.monotonic() - self._started
        for result in results:
            value = text_of(result.median) if result.ratios else result.outcome
            line = f'[{number}/{self._total}] {elapsed:4.0f} s  {result.name}: {value}'
            self._stream.write(f'{start}{line}\n')
            start = ''
        self._stream.flush()
