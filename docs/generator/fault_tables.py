# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of the fault campaign, from the records that `make faults JSON=...` wrote."""

import json
from collections.abc import Iterable, Mapping
from itertools import groupby
from operator import itemgetter
from typing import Any

from ddct_plant.program.table import Table
from generator.pages import DOCS

RECORDS = DOCS / 'examples' / 'faults.json'
"""File with the records of all cases, by their names."""
LONGEST = 150
"""Longest outcome in the table of all cases; the file has the whole."""


def fault_tables() -> Mapping[str, Table]:
    """Return the counts by fault, the cases that did not end as stated, and all cases."""
    records = list(json.loads(RECORDS.read_text(encoding='utf-8')).values())
    return {
        'counts': Table(
            'Cases by fault',
            ('fault', 'lock-step', 'real time', 'stated'),
            [_counts(fault, list(group)) for fault, group in _by_fault(records)],
        ),
        'misses': Table(
            'Cases that did not end as stated',
            ('case', 'stated', 'outcome'),
            [(_name(each), each['stated'], each['outcome']) for each in _misses(records)]
            or [('none', '', '')],
        ),
        'all': Table(
            'All cases',
            ('fault', 'mode', 'clutches', 'target and instant', 'outcome'),
            [row for _, group in _by_fault(records) for row in _outcomes(list(group))],
        ),
    }


def _by_fault(records: Iterable[dict[str, Any]]) -> Any:
    def fault(record: dict[str, Any]) -> str:
        return str(record['fault'])

    return groupby(sorted(records, key=fault), fault)


def _misses(records: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    return [record for record in records if record['tries'] and not record['as_stated']]


def _counts(fault: str, records: list[dict[str, Any]]) -> tuple[str, ...]:
    """Return how many of how many cases ended as stated, in each mode."""
    cells = []
    for mode in ('lockstep', 'realtime'):
        of_mode = [record for record in records if record['mode'] == mode]
        tried = [record for record in of_mode if record['tries']]
        good = len(tried) - len(_misses(tried))
        left = f', {len(of_mode) - len(tried)} not tried yet' if len(tried) < len(of_mode) else ''
        cells.append(f'{good} of {len(tried)}{left}' if of_mode else '')
    stated = dict.fromkeys(record['stated'] for record in records)
    shown = '; '.join(stated) if len(stated) <= 3 else 'by target: see below'
    return (fault, *cells, shown)


def _outcomes(records: list[dict[str, Any]]) -> list[tuple[str, ...]]:
    """Return a row for each outcome, with the targets that had it."""
    rows: dict[tuple[str, ...], list[str]] = {}
    for record in filter(itemgetter('tries'), records):
        text = record['outcome'] if record['as_stated'] else f'NOT AS STATED: {record["outcome"]}'
        short = text if len(text) <= LONGEST else f'{text[: LONGEST - 1]}…'
        key = (record['fault'], record['mode'], str(record['clutches']), short)
        rows.setdefault(key, []).append(_place(record))
    return [(*key[:3], ', '.join(places), key[3]) for key, places in rows.items()]


def _place(record: dict[str, Any]) -> str:
    instant = '' if record['instant'] in ('', 'middle') else f' ({record["instant"]})'
    return f'{record["target"]}{instant}'


def _name(record: dict[str, Any]) -> str:
    clutches = 'one clutch' if record['clutches'] == 1 else 'two clutches'
    return f'{record["fault"]}, {_place(record)}, {record["mode"]}, {clutches}'
