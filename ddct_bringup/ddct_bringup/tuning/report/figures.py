# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of a tuning: Optuna's plots of the study, with the held-out figures of the front."""

import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.tuning.result import Figures, FrontEntry, GoalEntry, TuningResult
from ddct_bringup.tuning.specification.goals import MINIMISE
from ddct_bringup.tuning.specification.parameters import LOG

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from optuna import Study
    from optuna.trial import FrozenTrial

_SIZE = (5.6, 4.2)
"""Width and height in inches: small, so that letters stay legible on a phone."""
_ACROSS = 2.6
"""Width in inches of the panel of a parameter."""
_HELD, _BEST, _BEFORE = '#c2410c', '#000000', '#000000'
"""Colours of held-out figures, of the ring of the best trial, and of the values of before."""
_LABELS = {
    'Infeasible Trial': 'breaks a constraint',
    'Feasible Trial': 'keeps all',
    'Best Trial': 'front, development',
}
"""Our words for those of Optuna's legend."""
_SPREAD = 3.0
"""Largest distance of a drawn trial from the front, in ranges of the front."""


def front_figure(result: TuningResult, study: 'Study', across: int, up: int) -> 'Figure':
    """Return the trials over two objectives, those of the front with their held-out figures."""
    from optuna.visualization.matplotlib import plot_pareto_front

    goals = result.objectives[across], result.objectives[up]

    def places(trial: 'FrozenTrial') -> Sequence[float]:
        return trial.values[across], trial.values[up]

    with _plots():
        axes: Axes = plot_pareto_front(
            study, targets=places, target_names=[_label(goal) for goal in goals]
        )
    for entry in result.front:
        _draw_held_out(axes, entry, goals, 'o')
        if entry.number == result.best:
            _scatter(axes, _place(entry.development, goals), 'o', 110, edgecolors=_BEST)
    if result.before:
        _draw_held_out(axes, result.before, goals, 's')
        _scatter(axes, _place(result.before.development, goals), 's', 36, color=_BEFORE)
        axes.scatter([], [], s=36, marker='s', color=_BEFORE, label='before')
    axes.scatter([], [], s=36, facecolors='none', edgecolors=_HELD, label='the same, held out')
    axes.scatter([], [], s=110, facecolors='none', edgecolors=_BEST, label='best')
    for each in axes.collections:
        each.set_label(_LABELS.get(str(each.get_label()), each.get_label()))
    _limit(axes, result, goals)
    figure = _figure(axes, _SIZE)
    if legend := axes.get_legend():
        legend.remove()
    figure.legend(loc='outside lower center', ncols=3, fontsize=8.5)
    return figure


def progress_figure(result: TuningResult, study: 'Study') -> 'Figure':
    """
    Return what the trials have reached, over their numbers.

    It is the best value of one objective, and of several the hypervolume between the front and the
    worst values of feasible trials.
    """
    from optuna.visualization.matplotlib import (
        plot_hypervolume_history,
        plot_optimization_history,
    )

    with _plots():
        if len(result.objectives) == 1:
            (goal,) = result.objectives
            return _figure(plot_optimization_history(study, target_name=_label(goal)), _SIZE)
        return _figure(plot_hypervolume_history(study, _worst(result, study)), _SIZE)


def _worst(result: TuningResult, study: 'Study') -> list[float]:
    """Return the worst value of each objective among the feasible trials."""
    kept = [
        each.values
        for each in study.get_trials(deepcopy=False)
        if each.values and not any(each.constraints.values())
    ]
    return [
        (max if goal.sense == MINIMISE else min)(values)
        for goal, values in zip(result.objectives, zip(*kept, strict=True), strict=True)
    ]


def slices_figure(study: 'Study', goal: GoalEntry, place: int) -> 'Figure':
    """Return the value of an objective over each parameter, without its highest tenth."""
    from matplotlib.ticker import NullFormatter
    from optuna.visualization.matplotlib import plot_slice

    with _plots():
        drawn: Any = plot_slice(study, target=_objective(place), target_name=_label(goal))
    panels: list[Axes] = np.atleast_1d(drawn).tolist()
    for panel in panels:
        if panel.get_xscale() == LOG:
            panel.xaxis.set_major_formatter('{x:g}')
            panel.xaxis.set_minor_formatter(NullFormatter())
    values = [each.values[place] for each in study.get_trials(deepcopy=False) if each.values]
    if values:
        low, high = min(values), float(np.quantile(values, 0.9))
        margin = 0.08 * ((high - low) or 1.0)
        panels[0].set_ylim(low - margin, high + margin)
    return _figure(panels[0], (_ACROSS * len(panels) + 1.0, _SIZE[1]))


def _objective(place: int) -> 'Callable[[FrozenTrial], float]':
    def value(trial: 'FrozenTrial') -> float:
        return float(trial.values[place])

    return value


def _figure(axes: 'Axes', size: tuple[float, float]) -> 'Figure':
    """Return the figure of axes without the title of its kind, which the page has."""
    figure = cast('Figure', axes.figure)
    figure.suptitle('')
    axes.set_title('')
    figure.set_size_inches(size)
    return figure


@contextmanager
def _plots() -> Iterator[None]:
    """Draw without a display, and leave out that Optuna's plots are experimental."""
    import matplotlib

    matplotlib.use('agg')
    with warnings.catch_warnings():
        warnings.simplefilter('ignore')
        yield


def _draw_held_out(
    axes: 'Axes', entry: FrontEntry, goals: tuple[GoalEntry, GoalEntry], marker: str
) -> None:
    """Draw the held-out figures of a trial, with a line from those in development."""
    ours, theirs = _place(entry.development, goals), _place(entry.held_out, goals)
    if ours and theirs:
        axes.plot(*zip(ours, theirs, strict=True), color=_HELD, linewidth=0.8)
        _scatter(axes, theirs, marker, 36, edgecolors=_HELD)


def _scatter(
    axes: 'Axes', place: tuple[float, float] | None, marker: str, size: float, **colours: Any
) -> None:
    if place is not None:
        given = {'facecolors': 'none', **colours} if 'edgecolors' in colours else colours
        x, y = place
        axes.scatter([x], [y], s=size, marker=marker, zorder=3, **given)


def _place(
    figures: Figures | None, goals: tuple[GoalEntry, GoalEntry]
) -> tuple[float, float] | None:
    values = figures.objectives if figures else {}
    x, y = (values.get(goal.name) for goal in goals)
    return None if x is None or y is None else (x, y)


def _limit(axes: 'Axes', result: TuningResult, goals: tuple[GoalEntry, GoalEntry]) -> None:
    """Leave out what is far from the front, which would press it into a corner."""
    drawn = [*result.front, *([result.before] if result.before else [])]
    bounds = axes.dataLim
    for goal, setting, ends in (
        (goals[0], axes.set_xlim, (bounds.x0, bounds.x1)),
        (goals[1], axes.set_ylim, (bounds.y0, bounds.y1)),
    ):
        values = [
            value
            for entry in drawn
            for figures in (entry.development, entry.held_out)
            if figures and (value := figures.objectives[goal.name]) is not None
        ]
        low, high = min(values), max(values)
        span = (high - low) or abs(high) or 1.0
        margin = 0.06 * span
        setting(
            max(low - _SPREAD * span, ends[0]) - margin,
            min(high + _SPREAD * span, ends[1]) + margin,
        )


def _label(goal: GoalEntry) -> str:
    unit = unit_text(goal.unit)
    return f'{goal.title}, {unit}' if unit else goal.title
