"""
Figures of several runs by controller, and how they order them: what claims in words rest on.

The thesis names no limits for the words of Table 5.2; what a word says is an order. They are
judged by one rule that was set after looking at the figures: a row of words holds where every
figure grows with the word, and within one word the largest is at most twice the smallest.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence

from ddct_bringup.reproduction.numbers.thesis_number import Finding
from ddct_bringup.reproduction.runs import HeadlessRun, thesis_run
from ddct_bringup.thesis.table_5_1 import FIGURES
from ddct_plant.base.timebase import steps_in

CLEARLY = 2.0
"""Factor behind `huge`, `very bad`, `no oscillations` and the only one that does something."""
WORN = (0.7, 1.3)
"""The two critical values of K_usura, inequality (3.2)."""
WORN_ARCHITECTURE = 'feedforward'
"""That of Figure 5.1, the only run with a worn clutch that the thesis shows."""
SLIP_WORDS = {'ls8': 'bad', 'hinf2': 'good', 'mpc3': 'bad', 'mpc4': 'average'}
"""Table 5.2: w_d, at both values of K_usura."""
OSCILLATION_WORDS = {
    0.7: {'ls8': 'high', 'hinf2': 'low', 'mpc3': 'average', 'mpc4': 'average'},
    1.3: dict.fromkeys(SLIP_WORDS, 'average'),
}
"""Table 5.2: w_sr and A_x by K_usura."""

_RANKS = {'good': 0, 'low': 0, 'average': 1, 'bad': 2, 'high': 2}
"""Of the words, from the best to the worst."""
_ALIKE = 2.0
"""Largest ratio of two figures that have the same word."""

Row = Mapping[str, float]
"""One figure by controller; infinite where it does not exist."""


def metric(name: str, controllers: Iterable[str], architecture: str = 'detailed') -> Row:
    """Return a metric of the runs with a new clutch, by controller."""
    return _metric_of(name, {each: thesis_run(each, architecture, 1.0) for each in controllers})


def _metric_of(name: str, runs: Mapping[str, HeadlessRun]) -> Row:
    found = {controller: getattr(run.metrics, name) for controller, run in runs.items()}
    return {
        controller: math.inf if value is None else float(value)
        for controller, value in found.items()
    }


def sigmas(controllers: Sequence[str], architecture: str = 'detailed') -> tuple[Row, Row]:
    """Return the standard deviations of w_sr in rpm and of A_x in m/s^2."""
    twist, acceleration = (metric(name, controllers, architecture) for name in FIGURES[1:])
    return twist, acceleration


def below(one: str, other: str, rows: Iterable[Row]) -> bool:
    """Return whether one controller has the lower figure in every row."""
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


def each_lower(ours: Sequence[Row], others: Sequence[Row], *, wanted: bool = True) -> Finding:
    """Return whether each controller, or none, is lower in every row than the same elsewhere."""
    names = list(ours[0])
    lower = [
        name
        for name in names
        if all(new[name] < old[name] for new, old in zip(ours, others, strict=True))
    ]
    which = ' in both' if len(ours) > 1 else ''
    return Finding(
        len(lower) == (len(names) if wanted else 0), f'{len(lower)} of {len(names)} lower{which}'
    )


def text(unit: str, row: Row) -> str:
    """Return the figures of a row for a reader."""
    parts = (
        f'{name} {value:.3g}' if value < math.inf else f'{name} -' for name, value in row.items()
    )
    return f'{", ".join(parts)} {unit}'


def sigma_text(rows: Sequence[Row], names: Iterable[str]) -> str:
    """Return the two standard deviations of some controllers for a reader."""
    twist, acceleration = ({name: row[name] for name in names} for row in rows)
    return f'w_sr {text("rpm", twist)}; A_x {text("m/s^2", acceleration)}'


def rows_of_table_5_2(runs: Mapping[str, HeadlessRun]) -> list[Row]:
    """Return |w_d| as the score window ends in rad/s, std w_sr in rpm and std A_x in m/s^2."""
    slips = {}
    for name, run in runs.items():
        end = steps_in('score_window_s', run.settings.scenario.score_window_s[1])
        slips[name] = abs(float(run.trajectory.slip_speed[end]))
    return [slips, *(_metric_of(name, runs) for name in FIGURES[1:])]


def judge_table_5_2(wear_gain: float, rows: Sequence[Row]) -> dict[str, Finding]:
    """Return what the printed words come to, by the gate's ids, of `rows_of_table_5_2`."""
    slips, twist, acceleration = rows
    words = {
        'w_d': judge_words(SLIP_WORDS, [('rad/s', slips)]),
        'w_sr': judge_words(
            OSCILLATION_WORDS[wear_gain], [('rpm', twist), ('m/s^2', acceleration)]
        ),
    }
    return {
        f'5.2 {name} {what} {wear_gain:g}': finding
        for what, found in words.items()
        for name, finding in found.items()
    }


def judge_words(
    words: Mapping[str, str], figures: Sequence[tuple[str, Row]]
) -> dict[str, Finding]:
    """
    Return what each controller's word comes to, by its name.

    `words` has the printed word by controller; `figures` a unit and the figures by controller, for
    each quantity that the words are about. A word holds when it is right beside all the others.
    """
    return {
        name: Finding(
            all(_stands(name, other, words, row) for _, row in figures for other in words),
            ', '.join(_text(row[name], unit) for unit, row in figures),
        )
        for name in words
    }


def words_of(row: Row) -> dict[str, str]:
    """
    Return the word that each controller's figure comes to by the rule of `judge_words`.

    From the least on, figures within twice the least of them have one word. The words are good,
    average and bad; of more groups than three all between are average, one group is alike.
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


def _stands(name: str, other: str, words: Mapping[str, str], row: Row) -> bool:
    """Return whether the figures of two controllers are as their words say."""
    order = _RANKS[words[name]] - _RANKS[words[other]]
    if order == 0:
        return max(row[name], row[other]) <= _ALIKE * min(row[name], row[other])
    return row[name] > row[other] if order > 0 else row[name] < row[other]


def _text(figure: float, unit: str) -> str:
    return f'{figure:.3g} {unit}' if figure < math.inf else 'no figure'
