# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What `limit` shows: the least values by lock time, controllers beside them, caps."""

from collections.abc import Iterable, Sequence
from typing import Any

from ddct_bringup.documents.document import Cell, Column, Document, Note, Table, given
from ddct_bringup.floor.front import ControllerRow, LeastLockTime
from ddct_bringup.floor.metric_units import METRICS
from ddct_bringup.floor.values import Floor
from ddct_plant.program.table import Weight


def limit_shown(
    title: str,
    floors: Sequence[Floor],
    rows: Sequence[ControllerRow],
    capped: Iterable[LeastLockTime],
) -> Document:
    """Return the document of floors, of controllers beside them and of least lock times."""
    return Document(
        'Limit',
        title,
        'No run of the clutch alone that locks at that time has less',
        given(
            _front_table(floors),
            _controllers_table(rows),
            *(Note(_capped_text(each)) for each in capped),
        ),
    )


def _front_table(floors: Sequence[Floor]) -> Table:
    columns = [
        Column('lock', 's', '.2f', weight=Weight.IDENTIFYING),
        Column('metric', number=False, weight=Weight.IDENTIFYING),
        Column('unit', number=False),
        Column('least', form='.4g'),
        Column('attained', form='.4g'),
        Column('gap', '%', '.1f'),
        Column('proof', number=False, weight=Weight.DETAIL),
    ]
    rows = [
        (
            each.lock_time_s,
            each.metric,
            METRICS[each.metric],
            *_with_reason(_no_floor(each), each.least, each.attained, each.gap),
            each.certificate.kind,
        )
        for each in floors
    ]
    return Table('least value of each metric by lock time, and what a run attains', columns, rows)


def _controllers_table(rows: Sequence[ControllerRow]) -> Table:
    columns = [
        Column('controller', number=False, weight=Weight.IDENTIFYING),
        Column('lock', 's', '.3f'),
        Column('metric', number=False, weight=Weight.IDENTIFYING),
        Column('value', form='.4g'),
        Column('least', form='.4g'),
        Column('over least', form='.2f'),
    ]
    shown = []
    for each in rows:
        lock, *figures = _with_reason(
            _no_ratio(each), each.lock_time_s, each.value, each.least, each.over_floor
        )
        shown.append((each.controller, lock, each.metric, *figures))
    return Table('controllers, over the least at their own lock time', columns, shown)


def _with_reason(reason: str, *values: Any) -> list[Cell]:
    """Return values as cells, those that are None with a reason."""
    return [Cell(value, reason=reason if value is None else '') for value in values]


def _no_floor(floor: Floor) -> str:
    """Return the reason of the dashes in a row of the front."""
    if floor.least is None:
        return 'no torque request locks the plates at that time with the engine below its cut'
    if floor.attained is None:
        return 'no run with that lock was found'
    return 'the least is 0'


def _no_ratio(row: ControllerRow) -> str:
    """Return the reason of the dashes in a row of the controllers."""
    if row.outside:
        return f'{row.controller} {row.outside}: no floor covers it'
    if row.value is None:
        return 'the run has no value of this metric'
    return 'no least is known at that lock time' if row.least is None else 'the least is 0'


def _capped_text(each: LeastLockTime) -> str:
    found = each.lock_time_s
    text = 'no lock time of the grid' if found is None else f'a lock at {found:g} s'
    before = each.excluded_before_s
    proof = 'proven for none' if before is None else f'impossible before {before:g} s'
    return f'{each.metric} of {each.cap:g} at most: {text}; {proof}'
