# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Metrics of several runs by controller and their order, the basis of qualitative claims.

The thesis defines no limits for the ratings of Table 5.2, such as `good`; a rating states an
order. They are judged by one rule that was set after the values were known: a row of ratings holds
where every value increases with the rating, and within one rating the largest is at most twice the
smallest.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence

from ddct_bringup.reproduction.numbers.thesis_number import Finding
from ddct_bringup.reproduction.study_run import StudyRun, study_run, thesis_run
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_plant.base.timebase import steps_in
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

CLEARLY = 2.0
"""Factor that `huge`, `very bad`, `no oscillations` and "the only one with an effect" require."""
WORN = (0.7, 1.3)
"""Critical values of K_usura, inequality (3.2)."""
WORN_ARCHITECTURE = 'feedforward'
"""Architecture of Figure 5.1, the only run with a worn clutch in the thesis."""
SLIP_RATINGS = {'ls8': 'bad', 'hinf2': 'good', 'mpc3': 'bad', 'mpc4': 'average'}
"""Ratings of w_d in Table 5.2, equal for both values of K_usura."""
OSCILLATION_RATINGS = {
    0.7: {'ls8': 'high', 'hinf2': 'low', 'mpc3': 'average', 'mpc4': 'average'},
    1.3: dict.fromkeys(SLIP_RATINGS, 'average'),
}
"""Ratings of w_sr and A_x in Table 5.2, by K_usura."""

_RANKS = {'good': 0, 'low': 0, 'average': 1, 'bad': 2, 'high': 2}
"""Ranks of the ratings, from the best to the worst."""
_ALIKE = 2.0
"""Largest ratio of two values with the same rating."""

Row = Mapping[str, float]
"""Values of one metric by controller; infinite where it does not exist."""


def metric(name: str, controllers: Iterable[str], architecture: str = 'detailed') -> Row:
    """Return a metric of the runs with a new clutch, by controller."""
    return _metric_of(name, {each: thesis_run(each, architecture, 1.0) for each in controllers})


def _metric_of(name: str, runs: Mapping[str, StudyRun]) -> Row:
    found = {controller: run.metrics[name] for controller, run in runs.items()}
    return {
        controller: math.inf if value is None else float(value)
        for controller, value in found.items()
    }


def sigmas(controllers: Sequence[str], architecture: str = 'detailed') -> tuple[Row, Row]:
    """Return the standard deviations of w_sr in rpm and of A_x in m/s^2."""
    twist, acceleration = (metric(name, controllers, architecture) for name in TABLE_METRICS[1:])
    return twist, acceleration


def below(one: str, other: str, rows: Iterable[Row]) -> bool:
    """Return whether one controller has the lower value in every row."""
    return all(row[one] < row[other] for row in rows)


def is_extreme(
    name: str, extreme: Callable[..., str], rows: Iterable[Row], factor: float = 1.0
) -> bool:
    """Return whether a controller is the `min` or `max` of every row, by a factor to the next."""
    for row in rows:
        next_one = row[extreme((other for other in row if other != name), key=row.__getitem__)]
        least, most = (row[name], next_one) if extreme is min else (next_one, row[name])
        if not factor * least < most:
            return False
    return True


def each_lower(ours: Sequence[Row], others: Sequence[Row], *, expected: bool = True) -> Finding:
    """Return whether each controller, or none, is lower in all rows of `ours` than of `others`."""
    names = list(ours[0])
    lower = [
        name
        for name in names
        if all(new[name] < old[name] for new, old in zip(ours, others, strict=True))
    ]
    which = ' in both' if len(ours) > 1 else ''
    return Finding(
        len(lower) == (len(names) if expected else 0), f'{len(lower)} of {len(names)} lower{which}'
    )


def text(unit: str, row: Row) -> str:
    """Return the values of a row as text."""
    parts = (
        f'{name} {value:.3g}' if value < math.inf else f'{name} -' for name, value in row.items()
    )
    return f'{", ".join(parts)} {unit}'


def sigma_text(rows: Sequence[Row], names: Iterable[str]) -> str:
    """Return the two standard deviations of some controllers as text."""
    twist, acceleration = ({name: row[name] for name in names} for row in rows)
    return f'w_sr {text("rpm", twist)}; A_x {text("m/s^2", acceleration)}'


def runs_of_table_5_2(scenario: Scenario, wear_gain: float) -> dict[str, StudyRun]:
    """Return the runs of the table's controllers in a scenario with a worn clutch, by name."""
    settings = RunSettings(
        KnownSettings(scenario, WORN_ARCHITECTURE), CaseSettings(wear_gain=wear_gain)
    )
    return {name: study_run(settings, name) for name in SLIP_RATINGS}


def rows_of_table_5_2(runs: Mapping[str, StudyRun]) -> list[Row]:
    """Return |w_d| at the window's end in rad/s, std w_sr in rpm and std A_x in m/s^2."""
    slips = {}
    for name, run in runs.items():
        end = steps_in('score_window_s', run.settings.scenario.score_window_s[1])
        slips[name] = abs(float(run.trajectory.slip_speed[end]))
    return [slips, *(_metric_of(name, runs) for name in TABLE_METRICS[1:])]


def judge_table_5_2(wear_gain: float, rows: Sequence[Row]) -> dict[str, Finding]:
    """Return the findings on the printed ratings by the gate's ids, from `rows_of_table_5_2`."""
    slips, twist, acceleration = rows
    ratings = {
        'w_d': judge_ratings(SLIP_RATINGS, [('rad/s', slips)]),
        'w_sr': judge_ratings(
            OSCILLATION_RATINGS[wear_gain], [('rpm', twist), ('m/s^2', acceleration)]
        ),
    }
    return {
        f'5.2 {name} {what} {wear_gain:g}': finding
        for what, found in ratings.items()
        for name, finding in found.items()
    }


def judge_ratings(
    ratings: Mapping[str, str], quantities: Sequence[tuple[str, Row]]
) -> dict[str, Finding]:
    """
    Return the finding on each controller's rating, by its name.

    `ratings` has the printed rating by controller; `quantities` a unit and the values by
    controller, for each metric that is rated. A rating holds when it is right relative to all the
    others.
    """
    return {
        name: Finding(
            all(
                _in_order(name, other, ratings, row) for _, row in quantities for other in ratings
            ),
            ', '.join(_text(row[name], unit) for unit, row in quantities),
        )
        for name in ratings
    }


def ratings_of(row: Row) -> dict[str, str]:
    """
    Return the rating of each controller's value by the rule of `judge_ratings`.

    In increasing order, values within twice the smallest of them have one rating. The ratings are
    good, average and bad; of more than three groups all inner ones are average, one group is
    alike.
    """
    groups: list[list[str]] = []
    for name in sorted(row, key=row.__getitem__):
        if groups and row[name] <= _ALIKE * row[groups[-1][0]]:
            groups[-1].append(name)
        else:
            groups.append([name])
    if len(groups) == 1:
        return dict.fromkeys(row, 'alike')
    best, worst = groups[0], groups[-1]
    return {
        name: 'good' if name in best else 'bad' if name in worst else 'average' for name in row
    }


def _in_order(name: str, other: str, ratings: Mapping[str, str], row: Row) -> bool:
    """Return whether the values of two controllers are in the order of their ratings."""
    order = _RANKS[ratings[name]] - _RANKS[ratings[other]]
    if order == 0:
        return max(row[name], row[other]) <= _ALIKE * min(row[name], row[other])
    return row[name] > row[other] if order > 0 else row[name] < row[other]


def _text(value: float, unit: str) -> str:
    return f'{value:.3g} {unit}' if value < math.inf else 'no figure'
