# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Convert dates with times of ISO 8601, as loggers write them, to seconds."""

import re
from collections.abc import Callable, Sequence

import numpy as np

from ddct_plant.base.errors import ParameterError

_EXAMPLE = '2026-05-01T10:00:00.125'
_DATE_TIME = re.compile(
    r'(?:\d{4}-\d\d-\d\d|\d{8})[T ](?:\d\d:\d\d:\d\d|\d{6})(?:[.,]\d+)?(Z|[+-]\d\d(?::?\d\d)?)?'
)
_OTHERS = {
    r'\d\d?:\d\d(:\d\d([.,]\d+)?)?': 'has no date, so that midnight is not known',
    r'\d{4}-\d\d-\d\d': 'has no time of day',
    r'\d{1,4}[./-]\d{1,2}[./-]\d{1,4}\b.*': 'can be read with the day or the month first, and is '
    'not of ISO 8601',
    '.*': 'is no date and time of ISO 8601',
}
"""Forms of other texts, with what is wrong."""


def is_date_time(text: str) -> bool:
    """Return whether a text has the form of a date with a time."""
    return _DATE_TIME.fullmatch(text) is not None


def seconds_since_first(
    cells: Sequence[str] | np.ndarray, place: Callable[[int], str]
) -> np.ndarray:
    """
    Return the times in s since the first date with a time, (n,), exact to a nanosecond.

    They are NaN for an empty cell. Without a time zone a date is in UTC. Raise ParameterError with
    the `place` of the row for another text, and for a time zone in some of the rows alone.
    """
    import pandas  # late: a run without a CSV file does not need it

    zones: list[bool] = []
    for row, cell in enumerate(cells):
        if not cell:
            continue
        found = _DATE_TIME.fullmatch(cell)
        if found is None:
            why = next(why for form, why in _OTHERS.items() if re.fullmatch(form, cell, re.DOTALL))
            raise ParameterError(f'{cell!r} {why}: write it as {_EXAMPLE}', place=place(row))
        zones.append(found[1] is not None)
        if zones[-1] != zones[0]:
            raise ParameterError(
                f'it has {"a" if zones[-1] else "no"} time zone, unlike the first row: give every '
                'row one, or none',
                place=place(row),
            )
    given = pandas.Series(cells, dtype=str).str.replace(',', '.')
    times = pandas.to_datetime(given, format='ISO8601', utc=True, errors='coerce')
    if (unread := np.flatnonzero(times.isna() & (given != ''))).size:
        row = int(unread[0])
        raise ParameterError(
            f'{cells[row]!r} is no date and time that exists: mend it', place=place(row)
        )
    nanoseconds = (times - times[times.first_valid_index() or 0]) / pandas.Timedelta(1, 'ns')
    return (nanoseconds / 1e9).to_numpy()
