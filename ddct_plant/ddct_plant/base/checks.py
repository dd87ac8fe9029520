"""Checks of single values, used when parameters are built and when messages arrive."""

import math
import re
from collections.abc import Sequence
from numbers import Real

from ddct_plant.base.errors import DdctError, ParameterError

MOST_CHARACTERS = 64
"""Longest name: a file name has two names and an ending, and may have 255 bytes."""
_NAME = re.compile(rf'[A-Za-z0-9_][A-Za-z0-9._-]{{0,{MOST_CHARACTERS - 1}}}')


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
    Return `value` as a float, or raise ParameterError that names it.

    `above` is an exclusive lower bound; `at_least` and `at_most` are inclusive.
    """
    if isinstance(value, bool) or not isinstance(value, Real):
        raise ParameterError(f'{name} is {value!r}: give a number{_in(unit)}')
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ParameterError(f'{name} is {number}: give a finite number{_in(unit)}')
    if above is not None and number <= above:
        raise ParameterError(f'{name} is {number:g}{_in(unit)}: it must be above {above:g}')
    if at_least is not None and number < at_least:
        raise ParameterError(f'{name} is {number:g}{_in(unit)}: it must be at least {at_least:g}')
    if at_most is not None and number > at_most:
        raise ParameterError(f'{name} is {number:g}{_in(unit)}: it must be at most {at_most:g}')
    return number


def require_name(what: str, name: object) -> None:
    """Raise ParameterError unless `name` of `what` is plain: it becomes the name of a file."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise ParameterError(
            f'{what} is {name!r}: use up to {MOST_CHARACTERS} letters (A to Z, a to z), digits, '
            'dots, dashes and underscores, no dot or dash first'
        )


def require_rising(name: str, times: Sequence[float]) -> None:
    """Raise ParameterError where one of `times`, called `name`, is not later than the last."""
    for earlier, later in zip(times, times[1:], strict=False):
        if later <= earlier:
            raise ParameterError(f'{name} goes from {earlier:g} to {later:g}: it must rise')


def require_choice(name: str, value: str, choices: Sequence[str]) -> None:
    """Raise ParameterError that names the choices when `value` is none of them."""
    if value not in choices:
        raise ParameterError(f'unknown {name} {value!r}: choose from {", ".join(choices)}')


def require_finite(source: str, value: float) -> float:
    """Return a number that `source` gave; raise DdctError when it is NaN or infinite."""
    if not math.isfinite(value):
        raise DdctError(f'{source} is {value}: mend what computes it')
    return value


def _in(unit: str) -> str:
    return f' {unit}' if unit else ''
