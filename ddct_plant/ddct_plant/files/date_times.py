# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Convert dates with times of ISO 8601, as loggers write them, to seconds."""

import math
import re
from collections.abc import Sequence
from datetime import UTC, datetime

from ddct_plant.base.errors import ParameterError

EXAMPLE = '2026-05-01T10:00:00.125'
_DATE_TIME = re.compile(
    r'(\d{4}-\d\d-\d\d|\d{8})[T ](\d\d:\d\d:\d\d|\d{6})(?:[.,](\d+))?(Z|[+-]\d\d(?::?\d\d)?)?'
)
_TIME_ALONE = re.compile(r'\d\d?:\d\d(:\d\d([.,]\d+)?)?')
_DATE_ALONE = re.compile(r'\d{4}-\d\d-\d\d')
_OTHER_DATE = re.compile(r'\d{1,4}[./-]\d{1,2}[./-]\d{1,4}\b.*')

Instant = tuple[int, float, bool]
"""Whole seconds since 1970, the fraction of a second, and whether the time zone is known."""


def is_date_time(text: str) -> bool:
    """Return whether a text has the form of a date with a time."""
    return _DATE_TIME.fullmatch(text) is not None


def instant(text: str) -> Instant:
    """
    Return the instant of a date with a time; without a time zone it is in UTC.

    Raise ParameterError with the reason for any other text.
    """
    found = _DATE_TIME.fullmatch(text)
    if found is None:
        raise ParameterError(f'{text!r} {_why_none(text)}: write it as {EXAMPLE}')
    date, time, digits, zone = found.groups()
    try:
        moment = datetime.fromisoformat(f'{date}T{time}{zone or ""}')
    except ValueError as error:
        raise ParameterError(f'{text!r} is no date and time that exists ({error})') from error
    whole = moment if zone else moment.replace(tzinfo=UTC)
    return int(whole.timestamp()), float(f'0.{digits or 0}'), zone is not None


def seconds_since_first(instants: Sequence[Instant | None]) -> list[float]:
    """Return the time in s since the first instant, exact to a nanosecond; NaN for None."""
    first = next((each for each in instants if each is not None), (0, 0.0, False))
    return [
        math.nan if each is None else (each[0] - first[0]) + (each[1] - first[1])
        for each in instants
    ]


def _why_none(text: str) -> str:
    if _TIME_ALONE.fullmatch(text):
        return 'has no date, so that midnight is not known'
    if _DATE_ALONE.fullmatch(text):
        return 'has no time of day'
    if _OTHER_DATE.fullmatch(text):
        return 'can be read with the day or the month first, and is not of ISO 8601'
    return 'is no date and time of ISO 8601'
