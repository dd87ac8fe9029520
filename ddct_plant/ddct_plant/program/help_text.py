# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The text of --help in the width of the terminal: sentences filled, commands on their lines."""

import argparse
import re
import textwrap

_REMARK = re.compile(r'^( +\S.*?\S) {2,}(\S.*)$')
"""A line with a command and, some spaces behind it, a remark."""
_UNDER = ' ' * 4
"""Further indentation of what does not fit on the line of its command."""


class HelpFormatter(argparse.RawDescriptionHelpFormatter):
    """Formatter whose descriptions and examples keep within the width of the terminal."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        return textwrap.indent(filled(text, width), indent)


def filled(text: str, width: int) -> str:
    """
    Return a text with lines of at most `width` characters.

    Successive lines that are not indented are one paragraph. An indented line that is too long
    continues below: its words after a backslash, so that a command can be copied, then its remark.
    """
    done: list[str] = []
    paragraph: list[str] = []
    for line in [*text.splitlines(), '']:
        if line and not line.startswith(' ') and not line.endswith(':'):
            paragraph.append(line)
            continue
        done += textwrap.wrap(' '.join(paragraph), width, break_on_hyphens=False)
        paragraph = []
        done += [line] if len(line) <= width else _continued(line, width)
    return '\n'.join(done[:-1])


def _continued(line: str, width: int) -> list[str]:
    """Return a line in several: the remark of one word in its column, of a command below it."""
    found = _REMARK.match(line)
    command, remark = found.groups() if found else (line, '')
    indent = command[: len(command) - len(command.lstrip())]
    column = line.index(remark, len(command)) if remark else 0
    if remark and ' ' not in command.strip():
        rows = textwrap.wrap(remark, width - column, break_on_hyphens=False)
        return [f'{command:{column}}{rows[0]}', *(' ' * column + row for row in rows[1:])]
    rows = textwrap.wrap(
        command.strip(),
        width - 2,
        initial_indent=indent,
        subsequent_indent=indent + _UNDER,
        break_on_hyphens=False,
        break_long_words=False,
    )
    rows = [*(f'{row} \\' for row in rows[:-1]), rows[-1]]
    below = textwrap.wrap(
        remark, width, initial_indent=indent + _UNDER, subsequent_indent=indent + _UNDER
    )
    return [*rows, *below]
