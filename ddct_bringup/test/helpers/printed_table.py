# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Read values from a printed table of runs by their headings."""

import re


def value_under(text: str, heading: str, controller: str, place: int = 0) -> tuple[str, str]:
    """
    Return (unit, value in the row of `controller`) of a column of numbers.

    Numbers end where their headings end. Of headings that read the same it is the one at `place`,
    in all blocks of the table.
    """
    lines = text.splitlines()
    number, end = [
        (number, match.end())
        for number, line in enumerate(lines)
        for match in re.finditer(rf'(?<=  ){re.escape(heading)}(?=  |$)', line)
    ][place]
    row = next(line for line in lines[number:] if controller in line.split())
    units = next(line for line in lines[number:] if 'controller' in line.split())
    return _word_that_ends(units, end), _word_that_ends(row, end)


def _word_that_ends(line: str, end: int) -> str:
    return next(word[0] for word in re.finditer(r'\S+', line) if word.end() == end)
