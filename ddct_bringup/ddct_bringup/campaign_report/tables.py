# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Cells and tables that the documents of a campaign and of a benchmark share."""

from collections.abc import Iterator, Sequence

from ddct_bringup.campaign_report import texts
from ddct_bringup.documents.document import (
    Bar,
    Cell,
    Column,
    Row,
    Table,
    Terms,
)
from ddct_bringup.evaluation.attribution import Effect
from ddct_bringup.evaluation.case_figures import RESPONSE
from ddct_bringup.evaluation.paired import PairedDifference
from ddct_bringup.evaluation.quantities import QUANTITIES
from ddct_bringup.evaluation.share import Share
from ddct_bringup.evaluation.spread import Quantiles
from ddct_bringup.evaluation.summary import PairSummary
from ddct_bringup.metrics.catalogue import FIGURES, TABLE_5_1
from ddct_plant.program.table import Weight

MAIN = tuple(each.key for each in (RESPONSE, *FIGURES, *TABLE_5_1))
"""Response, figures and metrics of Table 5.1, which are shown first."""
NO_VALUE = 'no engaged run has a value'
"""Reason of a dash."""
_NAME = Weight.IDENTIFYING
EFFECT_COLUMNS = (
    Column('key', number=False, weight=_NAME),
    Column('drives failure', number=False),
    Column('explains', form='.2f'),
    Column('95 % interval'),
    Column('p'),
    Column('most failures', number=False, missing='the key has no evidence'),
)
"""Columns of `effect_cells`."""


def share_cell(share: Share, *, bad: bool = False) -> Cell:
    """Return a share with its bar; one of failures is `bad`."""
    if share.value is None:
        return Cell(None)
    ends = None if share.low is None or share.high is None else (share.low, share.high)
    return Cell(share.value, bar=Bar(share.value, ends, bad))


def interval_cell(share: Share) -> Cell:
    """Return the interval of a share."""
    return Cell(None if share.low is None else share.interval_text)


def effect_cells(found: Effect) -> Row:
    """Return the effect of a key on failure."""
    return (
        found.key,
        Cell('yes' if found.drives else 'no evidence', alarming=found.drives),
        found.explained,
        '{:.2f} to {:.2f}'.format(*found.interval),
        texts.p_text(found.p_value),
        texts.part_text(found.worst_part) if found.drives else None,
    )


def meanings(keys: Sequence[str]) -> Terms:
    """Return the meanings of quantities by symbol."""
    return Terms({QUANTITIES[key].symbol: QUANTITIES[key].meaning for key in keys})


def quantity_cell(key: str) -> Cell:
    """Return the symbol and the unit of a quantity, with its meaning as the hint."""
    quantity = QUANTITIES[key]
    return Cell(quantity.symbol, unit=quantity.unit, hint=quantity.meaning)


def quantile_cells(found: Quantiles, form: str) -> Iterator[Cell]:
    """Yield P5, P50 and P95."""
    return (Cell(value, form) for value in (found.p5, found.p50, found.p95))


def difference_interval(found: PairedDifference, form: str) -> str | None:
    """Return the interval of the median difference."""
    if found.interval is None:
        return None
    return ' to '.join(format(end, form) for end in found.interval)


def differences_table(pairs: Sequence[PairSummary], keys: Sequence[str]) -> Table:
    """Return the differences of pairs of controllers in quantities."""
    columns = [
        Column('quantity', number=False, weight=_NAME, symbols=True),
        Column('controllers', number=False, weight=_NAME),
        Column('cases', form='d', weight=Weight.USEFUL),
        Column('P5', missing=NO_VALUE, weight=Weight.USEFUL),
        Column('P50', missing=NO_VALUE),
        Column('P95', missing=NO_VALUE, weight=Weight.USEFUL),
        Column('95 % interval of P50', missing='too few cases, or no random sample'),
    ]
    rows = [
        (
            quantity_cell(key),
            pair.label,
            found.cases,
            *quantile_cells(found.quantiles, QUANTITIES[key].form),
            difference_interval(found, QUANTITIES[key].form),
        )
        for key in keys
        for pair in pairs
        if key in pair.differences
        for found in [pair.differences[key]]
    ]
    return Table('', columns, rows, notes=['interval: sign test'])


def outcomes_table(pairs: Sequence[PairSummary], title: str) -> Table:
    """Return in how many cases both, one or none of two controllers engaged."""
    columns = [
        Column('controllers', number=False, weight=_NAME),
        Column('both engaged', number=False),
    ]
    rows = [(pair.label, texts.joint_outcomes_text(pair)) for pair in pairs]
    return Table(title, columns, rows)
