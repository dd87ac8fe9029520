# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Charts of a tuning: its trials over two objectives, over each parameter, and in time."""

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.documents.chart import Chart, ChartAxis, Item, Line, Marks, Panel
from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.documents.palette import NEUTRAL, LineLook, looks
from ddct_bringup.tuning.result import Figures, GoalEntry, TuningResult
from ddct_bringup.tuning.specification.goals import MINIMISE
from ddct_bringup.tuning.specification.parameters import LOG

if TYPE_CHECKING:
    from optuna import Study
    from optuna.trial import FrozenTrial

_DEVELOPED, _HELD, _BEFORE = looks(3)
_Place = tuple[float, float]
_ACROSS = 3
_SPREAD = 3.0
"""Largest distance of a drawn trial from the front, in ranges of the front."""
_HEIGHT_PX = 340


def front_chart(result: TuningResult, study: 'Study', across: int, up: int) -> Chart:
    """Return the trials over two objectives, those of the front with their held-out figures."""
    goals = result.objectives[across], result.objectives[up]
    kept, broken = _trials(study)
    developed = [_place(entry.development, goals) for entry in result.front]
    held_out = [_place(entry.held_out, goals) for entry in result.front]
    best = [_place(e.development, goals) for e in result.front if e.number == result.best]
    before = [_place(result.before.development, goals)] if result.before else []
    before_held = [_place(result.before.held_out, goals)] if result.before else []
    of_all = [[(each.values[across], each.values[up]) for each in some] for some in (broken, kept)]
    items: list[Item] = [
        _points(of_all[0], NEUTRAL, 'breaks a constraint', opacity=0.5),
        _points(of_all[1], _DEVELOPED.colour, 'keeps all', opacity=0.5),
        *(
            _line(pair)
            for pair in zip([*developed, *before], [*held_out, *before_held], strict=True)
        ),
        _points(developed, _DEVELOPED.colour, 'front, development', size=10.0),
        _points(held_out, _HELD.colour, 'the same, held out', filled=False, size=9.0),
        _points(best, NEUTRAL, 'best', filled=False, size=18.0),
    ]
    if before:
        items += [
            _points(before, _BEFORE.colour, 'before', mark='square', size=9.0),
            _points(before_held, _HELD.colour, '', mark='square', filled=False, size=9.0),
        ]
    drawn = np.array([*of_all[0], *of_all[1]])
    axes = [
        ChartAxis(_label(goal), _span(result, goal, values))
        for goal, values in zip(goals, drawn.T, strict=True)
    ]
    title = f'{goals[0].title} and {goals[1].title}'
    return Chart(title, (Panel(tuple(items), axes[0], axes[1], height_px=_HEIGHT_PX),))


def progress_chart(result: TuningResult, study: 'Study') -> Chart:
    """
    Return what the trials have reached, over their numbers.

    It is the best value of one objective, and of several the hypervolume between the front and the
    worst values of feasible trials.
    """
    kept, broken = _trials(study)
    across = ChartAxis('number of the trial')
    if len(result.objectives) > 1:
        numbers, volumes = _volumes(result, study, kept)
        line = Line(numbers, volumes, _DEVELOPED, 'hypervolume', steps=True)
        return Chart('Convergence', (Panel((line,), across, ChartAxis('hypervolume')),))
    (goal,) = result.objectives
    places = [[(each.number, each.values[0]) for each in some] for some in (broken, kept)]
    numbers, values = _columns(places[1])
    best = np.minimum if goal.sense == MINIMISE else np.maximum
    items = (
        _points(places[0], NEUTRAL, 'breaks a constraint', opacity=0.6),
        _points(places[1], _DEVELOPED.colour, 'keeps all', opacity=0.6),
        Line(numbers, best.accumulate(values), _HELD, 'best so far', steps=True),
    )
    return Chart('Convergence', (Panel(items, across, ChartAxis(_label(goal))),))


def slices_chart(result: TuningResult, study: 'Study', place: int) -> Chart:
    """Return the value of an objective over each parameter, without its highest tenth."""
    goal = result.objectives[place]
    kept, broken = _trials(study)
    values = [each.values[place] for each in (*kept, *broken) if each.values]
    low, high = min(values), float(np.quantile(values, 0.9))
    margin = 0.08 * ((high - low) or 1.0)
    panels = tuple(
        Panel(
            tuple(
                _points(
                    [(each.params[name], each.values[place]) for each in trials],
                    colour,
                    label,
                    opacity=0.6,
                )
                for trials, colour, label in (
                    (broken, NEUTRAL, 'breaks a constraint'),
                    (kept, _DEVELOPED.colour, 'keeps all'),
                )
            ),
            ChartAxis(name, logarithmic=searched.scale == LOG),
            ChartAxis(_label(goal), (low - margin, high + margin)),
        )
        for name, searched in sorted(result.parameters.items())
    )
    return Chart(goal.title, panels, columns=min(_ACROSS, len(panels)), same_y=True)


def _trials(study: 'Study') -> 'tuple[list[FrozenTrial], list[FrozenTrial]]':
    """Return the trials with values that keep all constraints, and those that break one."""
    found = [each for each in study.get_trials(deepcopy=False) if each.values]
    kept = [each for each in found if not any(each.constraints.values())]
    return kept, [each for each in found if any(each.constraints.values())]


def _points(
    places: Sequence[_Place | None],
    colour: str,
    label: str,
    *,
    mark: str = 'circle',
    filled: bool = True,
    size: float = 7.0,
    opacity: float = 1.0,
) -> Marks:
    across, up = _columns(places)
    return Marks(across, up, colour, label, mark, filled, size, opacity)


def _volumes(
    result: TuningResult, study: 'Study', kept: 'Sequence[FrozenTrial]'
) -> tuple[np.ndarray, np.ndarray]:
    """Return numbers of trials and hypervolumes, which Optuna gives only as a plotted line."""
    import matplotlib
    from matplotlib import pyplot
    from optuna.visualization.matplotlib import plot_hypervolume_history

    worst = [
        (max if goal.sense == MINIMISE else min)(values)
        for goal, values in zip(
            result.objectives, zip(*(each.values for each in kept), strict=True), strict=True
        )
    ]
    backend = matplotlib.get_backend()
    matplotlib.use('agg')
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # its plots are experimental
            axes = plot_hypervolume_history(study, worst)
        pyplot.close(axes.figure)  # type: ignore[arg-type]
    finally:
        matplotlib.use(backend)
    (line,) = axes.get_lines()
    numbers, volumes = (np.asarray(each, float) for each in (line.get_xdata(), line.get_ydata()))
    return numbers, volumes


def _line(places: Sequence[_Place | None]) -> Line:
    """Return the line from the figures of a trial in development to those held out."""
    across, up = _columns(places)
    return Line(across, up, LineLook(_HELD.colour), width=1.0)


def _place(figures: Figures | None, goals: tuple[GoalEntry, GoalEntry]) -> _Place | None:
    values = figures.objectives if figures else {}
    x, y = (values.get(goal.name) for goal in goals)
    return None if x is None or y is None else (x, y)


def _columns(places: Sequence[_Place | None]) -> tuple[np.ndarray, np.ndarray]:
    """Return the x and y of the places that there are, each (n,)."""
    found = np.array([place for place in places if place is not None], dtype=float).reshape(-1, 2)
    return found[:, 0], found[:, 1]


def _span(result: TuningResult, goal: GoalEntry, drawn: np.ndarray) -> tuple[float, float]:
    """Return the range shown: what is far from the front would press it into a corner."""
    entries = [*result.front, *([result.before] if result.before else [])]
    values = [
        value
        for entry in entries
        for figures in (entry.development, entry.held_out)
        if figures and (value := figures.objectives[goal.name]) is not None
    ]
    low, high = min(values), max(values)
    span = (high - low) or abs(high) or 1.0
    margin = 0.06 * span
    ends = min(low, float(np.min(drawn))), max(high, float(np.max(drawn)))
    return (
        max(low - _SPREAD * span, ends[0]) - margin,
        min(high + _SPREAD * span, ends[1]) + margin,
    )


def _label(goal: GoalEntry) -> str:
    unit = unit_text(goal.unit)
    return f'{goal.title}, {unit}' if unit else goal.title
