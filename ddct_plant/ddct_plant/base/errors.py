# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Errors for users, printed in one line, and the checks of values that raise them."""

import difflib
import math
import re
from collections.abc import Iterable, Sequence
from numbers import Real
from typing import Self

_LONGEST_LINE = 4000
"""Largest length of an error text; a longer one loses its middle, as the beginning has the error
and the end the advice."""
_KEPT_AT_END = 1000
_CUT = ' [...] '
LONGEST_NAME = 64
"""Largest length of a name: a file name has two names and an ending, and at most 255 bytes."""
_NAME = re.compile(rf'[A-Za-z0-9_][A-Za-z0-9._-]{{0,{LONGEST_NAME - 1}}}')


class DdctError(Exception):
    """
    Error for users: what is wrong, where, and what to do about it, in one line.

    The text may contain parts of a file or a message. Characters that a terminal would not print
    are escaped here, so that they cannot reach a terminal, a log or a page.
    """

    def __init__(self, text: object, *, key: str = '', place: object = '') -> None:
        """
        Make the text printable and store it, with `place` before it.

        `key` is the option, parameter, topic or key of a file to change, '' where there is none;
        the text names it. `place` is where the cause is: a file, and the line or column there.
        """
        super().__init__(printable(f'{place}: {text}' if place else text))
        self.key = key
        self.place = str(place)

    def at(self, place: object) -> Self:
        """Return the same error with a place around that which it has."""
        found = type(self)(f'{place}: {self}', key=self.key)
        found.place = f'{place}: {self.place}' if self.place else str(place)
        return found


class ForeignError(DdctError):
    """Error of a third party's code, which is its cause; a node's log has the traceback."""


class ParameterError(DdctError, ValueError):
    """A parameter, option or scenario key has a value that cannot be used."""


_FOLDERS = re.compile(
    r"""
    (?P<ros>:=\S+|\b(?:nodes?|publishers:)(?:\ (?:and\ )?/\S+)+|(?<!\S)/\S*/clock(?![\w.]))
    |(?<![\w.])(?:/(?:[^\s/:'"()<>]+/)+|[A-Za-z]:[/\\](?:[^\s/\\:'"()<>]+[/\\])+)
    """,
    re.VERBOSE,
)
"""Folders of an absolute path in a text, of Windows too; names of ROS are matched to be kept:
those behind a remap, of nodes, and of the clock of a graph."""


def without_folders(text: str) -> str:
    """Return the reason of a run, as a result keeps it, with files named without their folders."""
    return _FOLDERS.sub(lambda found: found['ros'] or '', text)


FOREIGN_FAILURES = (Exception, SystemExit)
"""Exceptions to catch from a third party's code: sys.exit would end the program silently."""


def printable(text: object) -> str:
    r"""
    Return text from files, bags and messages as one line without control characters.

    Control and invisible characters (ANSI codes, line ends, marks of direction, lone surrogates)
    are written as an escape such as \x1b.
    """
    line = str(text)
    if len(line) > _LONGEST_LINE:
        line = line[: _LONGEST_LINE - _KEPT_AT_END] + _CUT + line[-_KEPT_AT_END:]
    if line.isprintable():
        return line
    return ''.join(
        character if character.isprintable() else character.encode('unicode_escape').decode()
        for character in line
    )


def require_number(
    name: str,
    value: object,
    *,
    unit: str = '',
    above: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
) -> float:
    """
    Return `value` as a finite float; raise ParameterError that names it otherwise.

    `above` is an exclusive lower bound; `at_least` and `at_most` are inclusive.
    """
    # The check of the abstract class is slow, and most numbers are floats.
    if type(value) is not float and (isinstance(value, bool) or not isinstance(value, Real)):
        raise ParameterError(f'{name} is {value!r}: give a number{_in_unit(unit)}', key=name)
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ParameterError(f'{name} is {number}: give a finite number{_in_unit(unit)}', key=name)
    if above is not None and number <= above:
        raise ParameterError(
            f'{name} is {number:g}{_unit_suffix(unit)}: it must be above {above:g}', key=name
        )
    if at_least is not None and number < at_least:
        raise ParameterError(
            f'{name} is {number:g}{_unit_suffix(unit)}: it must be at least {at_least:g}', key=name
        )
    if at_most is not None and number > at_most:
        raise ParameterError(
            f'{name} is {number:g}{_unit_suffix(unit)}: it must be at most {at_most:g}', key=name
        )
    return number


def require_name(what: str, name: object) -> None:
    """Raise ParameterError unless `name`, called `what`, can be a part of a file name."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise ParameterError(
            f'{what} is {name!r}: use up to {LONGEST_NAME} letters (A to Z, a to z), digits, '
            'dots, dashes and underscores, no dot or dash first',
            key=what,
        )


def did_you_mean(name: object, known: Iterable[str], prefix: str = '') -> str:
    """Return a question with the known name that is closest to an unknown one, empty for none."""
    close = difflib.get_close_matches(str(name), list(known), n=1)
    return f'did you mean {prefix}{close[0]}?' if close else ''


def choices_hint(name: object, choices: Iterable[str]) -> str:
    """Return a hint for an unknown name: the closest choice if one is alike, and all choices."""
    choices = list(choices)
    meant, every = did_you_mean(name, choices), f'choose from {", ".join(choices)}'
    return f'{meant} Else {every}' if meant else every


def require_choice(name: str, value: str, choices: Sequence[str]) -> None:
    """Raise ParameterError that names the choices when `value` is none of them."""
    if value not in choices:
        raise ParameterError(f'unknown {name} {value!r}: {choices_hint(value, choices)}', key=name)


MOST_SIGNAL = 1e150
"""Largest size of a signal, in its SI unit: the square of a larger one would not be finite."""


def require_signal(source: str, value: float) -> float:
    """Return the value of a signal; raise DdctError for NaN, or a size beyond MOST_SIGNAL."""
    if not abs(value) <= MOST_SIGNAL:
        beyond = f', beyond +-{MOST_SIGNAL:g}' if math.isfinite(value) else ''
        raise DdctError(f'{source} is {value:g}{beyond}: mend what computes it', key=source)
    return value


def _unit_suffix(unit: str) -> str:
    return f' {unit}' if unit else ''


def _in_unit(unit: str) -> str:
    return f' in {unit}' if unit else ''
