# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Table 5.2 in numbers, with the thesis's linear clutch and with the stick-slip clutch."""

import math
from collections.abc import Mapping

from ddct_bringup.reproduction.numbers.thesis_number import Finding
from ddct_bringup.reproduction.studies.study import FINER_WEAR_GAINS, Study
from ddct_bringup.reproduction.study_run import THESIS_SCENARIO, study_run
from ddct_bringup.reproduction.values.orders import (
    OSCILLATION_RATINGS,
    SLIP_RATINGS,
    WORN,
    WORN_ARCHITECTURE,
    Row,
    judge_table_5_2,
    ratings_of,
    rows_of_table_5_2,
)
from ddct_bringup.verdict.state import NOT_ENGAGED, SUCCESSES
from ddct_plant.models.clutch import CLUTCHES
from ddct_plant.scenario.settings import RunSettings


def table_5_2_in_numbers() -> Study:
    """Return the values, the ratings that follow from them and the printed ones."""
    return Study(
        f'Table 5.2 in numbers, architecture {WORN_ARCHITECTURE}',
        (
            'clutch',
            'K_usura',
            'controller',
            '|w_d| as the score window ends rad/s',
            'std w_sr rpm',
            'std A_x m/s^2',
            'state',
            'w_d, ours',
            'w_sr, ours',
            'A_x, ours',
            'w_d, printed',
            'w_sr and A_x, printed',
        ),
        [row for clutch in CLUTCHES for gain in FINER_WEAR_GAINS for row in rows_of(clutch, gain)],
    )


def rows_of(clutch: str, wear_gain: float) -> list[tuple[str, ...]]:
    """Return the rows of the table for a clutch and a wear gain, one for each controller."""
    settings = RunSettings(THESIS_SCENARIO, WORN_ARCHITECTURE, clutch=clutch, wear_gain=wear_gain)
    runs = {name: study_run(settings, name) for name in SLIP_RATINGS}
    states = {name: run.verdict.state for name, run in runs.items()}
    rows = rows_of_table_5_2(runs)
    ranked = [_with_states(row, states) for row in rows]
    words = [ratings_of(row) for row in ranked]
    printed = judge_table_5_2(wear_gain, ranked) if wear_gain in WORN else {}
    return [
        (
            clutch,
            f'{wear_gain:g}',
            name,
            *(f'{row[name]:.3g}' for row in rows),
            states[name],
            *(row[name] for row in words),
            _printed(printed.get(f'5.2 {name} w_d {wear_gain:g}'), SLIP_RATINGS[name]),
            _printed(
                printed.get(f'5.2 {name} w_sr {wear_gain:g}'),
                OSCILLATION_RATINGS.get(wear_gain, {}).get(name, ''),
            ),
        )
        for name in SLIP_RATINGS
    ]


def _with_states(row: Row, states: Mapping[str, str]) -> Row:
    """Return the values, infinite for a failed run: a small one is no good result there."""
    return {
        name: value if states[name] in (*SUCCESSES, NOT_ENGAGED) else math.inf
        for name, value in row.items()
    }


def _printed(finding: Finding | None, word: str) -> str:
    """Return the printed rating and whether it holds; a dash where the thesis prints none."""
    if finding is None:
        return '-'
    return f'{word}: {"holds" if finding.holds else "does not hold"}'
