# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Table 5.2 in numbers, with the thesis's linear clutch and with the stick-slip clutch."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ddct_bringup.reproduction.numbers.thesis_number import Finding
from ddct_bringup.reproduction.studies.study import FINER_WEAR_GAINS, Study, identified_by
from ddct_bringup.reproduction.study_run import StudyRun
from ddct_bringup.reproduction.values.orders import (
    OSCILLATION_RATINGS,
    SLIP_RATINGS,
    WORN,
    WORN_ARCHITECTURE,
    Row,
    judge_table_5_2,
    ratings_of,
    rows_of_table_5_2,
    runs_of_table_5_2,
)
from ddct_bringup.verdict.state import ENGAGED, NOT_ENGAGED
from ddct_plant.program.table import Weight
from ddct_plant.scenario.file import load_scenario

SCENARIOS = {'thesis': 'linear', 'thesis_sticking': 'sticks'}
"""Clutch by the name of the scenario: the thesis's linear one, and the one that sticks."""


@dataclass(frozen=True)
class RatedRow:
    """One run of Table 5.2: its values, the ratings that follow, and the printed ones."""

    scenario: str
    wear_gain: float
    """Wear gain K_usura."""
    controller: str
    slip_end_rad_s: float
    """Magnitude of w_d at the end of the score window in rad/s."""
    torsion_speed_std_rpm: float
    """Standard deviation of w_sr in rpm."""
    acceleration_std_m_s2: float
    """Standard deviation of A_x in m/s^2."""
    state: str
    """State of the run."""
    slip_rating: str
    """Rating of w_d by the rule of `ratings_of`; the next two are those of w_sr and A_x."""
    torsion_rating: str
    acceleration_rating: str
    slip_printed: str | None
    """Printed rating of w_d; None at a wear gain that the thesis does not rate."""
    slip_holds: bool | None
    """Whether our runs confirm it."""
    oscillations_printed: str | None
    """Printed rating of w_sr and A_x, which is one word for both."""
    oscillations_hold: bool | None

    @property
    def sigmas(self) -> tuple[float, float]:
        """Standard deviations of w_sr in rpm and of A_x in m/s^2."""
        return self.torsion_speed_std_rpm, self.acceleration_std_m_s2


def table_5_2_in_numbers() -> Study:
    """Return the values, the ratings that follow from them and the printed ones."""
    return Study(
        f'Table 5.2 in numbers, architecture {WORN_ARCHITECTURE}, by wear gain K_usura',
        (
            'clutch',
            'wear',
            'controller',
            '|w_d| at the end rad/s',
            'std w_sr rpm',
            'std A_x m/s^2',
            'state',
            'ours: w_d',
            'ours: w_sr',
            'ours: A_x',
            'print: w_d',
            'print: w_sr, A_x',
        ),
        [row for name in SCENARIOS for gain in FINER_WEAR_GAINS for row in rows_of(name, gain)],
        weights=(*identified_by(3), *[Weight.NEEDED] * 3, Weight.USEFUL),
    )


def rows_of(scenario: str, wear_gain: float) -> list[tuple[str, ...]]:
    """Return the rows of the table for a scenario and a wear gain, one for each controller."""
    return [
        (
            SCENARIOS[row.scenario],
            f'{row.wear_gain:g}',
            row.controller,
            *(f'{value:.3g}' for value in (row.slip_end_rad_s, *row.sigmas)),
            row.state,
            *(row.slip_rating, row.torsion_rating, row.acceleration_rating),
            _printed(row.slip_printed, row.slip_holds),
            _printed(row.oscillations_printed, row.oscillations_hold),
        )
        for row in rated_rows(scenario, wear_gain)
    ]


def rated_rows(scenario: str, wear_gain: float) -> list[RatedRow]:
    """Return the rated runs of the table's controllers in a scenario with a wear gain."""
    runs = runs_of_table_5_2(load_scenario(scenario), wear_gain)
    states = {name: run.scores.state for name, run in runs.items()}
    slips, torsion, acceleration = rows_of_table_5_2(runs)
    ranked = [_of_sound(row, runs) for row in (slips, torsion, acceleration)]
    slip_words, torsion_words, acceleration_words = (ratings_of(row) for row in ranked)
    judged = judge_table_5_2(wear_gain, ranked) if wear_gain in WORN else {}
    return [
        RatedRow(
            scenario,
            wear_gain,
            name,
            slips[name],
            torsion[name],
            acceleration[name],
            states[name],
            slip_words[name],
            torsion_words[name],
            acceleration_words[name],
            slip_printed=SLIP_RATINGS[name] if judged else None,
            slip_holds=_holds(judged, f'5.2 {name} w_d {wear_gain:g}'),
            oscillations_printed=OSCILLATION_RATINGS.get(wear_gain, {}).get(name),
            oscillations_hold=_holds(judged, f'5.2 {name} w_sr {wear_gain:g}'),
        )
        for name in SLIP_RATINGS
    ]


def _of_sound(row: Row, runs: Mapping[str, StudyRun]) -> Row:
    """Return the values, infinite for a failed run: a small one is no good result there."""
    return {name: value if _is_sound(runs[name]) else math.inf for name, value in row.items()}


def _is_sound(run: StudyRun) -> bool:
    """Return whether a run engaged, or at least ends with less slip than control begins with."""
    slip = abs(run.slip_rpm)
    return run.scores.state == ENGAGED or (
        run.scores.state == NOT_ENGAGED and bool(slip[-1] < slip[run.start])
    )


def _holds(judged: Mapping[str, Finding], name: str) -> bool | None:
    finding = judged.get(name)
    return None if finding is None else finding.holds


def _printed(word: str | None, holds: bool | None) -> str:
    """Return the printed rating and whether ours is a hit; a dash where the thesis prints none."""
    return '-' if word is None else f'{word} {"hit" if holds else "miss"}'
