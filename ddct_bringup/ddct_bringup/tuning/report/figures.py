# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of a tuning: the front, convergence, and what each parameter decides."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.report.page_parts import unit_text
from ddct_bringup.tuning.result import Figures, FrontEntry, GoalEntry, TuningResult
from ddct_bringup.tuning.specification.parameters import LOG
from ddct_bringup.tuning.trial import FEASIBLE, TrialEntry

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIZE = (5.6, 4.2)
"""Width and height in inches: small, so that letters stay legible on a phone."""
_TRIED, _FRONT, _HELD, _BEFORE = '#9a9a9a', '#0b62a4', '#c2410c', '#000000'
"""Colours of other trials, of the front, of held-out figures, and of the values of before."""
_SPREAD = 3.0
"""Largest distance of a drawn trial from the front, in ranges of the front."""


def front_figure(
    result: TuningResult, trials: Sequence[TrialEntry], across: int, up: int
) -> 'Figure':
    """Return the trials over two objectives, those of the front with their held-out figures."""
    from matplotlib.figure import Figure

    goals = result.objectives
    first, second = goals[across], goals[up]
    figure = Figure(figsize=_SIZE)
    axes = figure.subplots()
    shown = [each for each in trials if each.state == FEASIBLE]
    places = [(e.objectives[first.name], e.objectives[second.name]) for e in shown]
    across_up = np.array(places, dtype=float).reshape(-1, 2).T
    axes.scatter(across_up[0], across_up[1], s=12, color=_TRIED, label='trial that keeps all')
    for entry in result.front:
        _draw_pair(axes, entry, first, second, _FRONT, best=entry.number == result.best)
    if result.before:
        _draw_pair(axes, result.before, first, second, _BEFORE, best=False)
    axes.scatter([], [], s=36, color=_FRONT, label='front, development')
    axes.scatter([], [], s=36, facecolors='none', edgecolors=_HELD, label='the same, held out')
    axes.scatter([], [], s=110, facecolors='none', edgecolors=_FRONT, label='best')
    if result.before:
        axes.scatter([], [], s=36, marker='s', color=_BEFORE, label='before')
    axes.set_xlabel(_label(first))
    axes.set_ylabel(_label(second))
    _limit(axes, result, first, second)
    figure.legend(loc='outside lower center', ncols=3, fontsize=8.5)
    return figure


def _draw_pair(
    axes: 'Axes',
    entry: FrontEntry,
    first: GoalEntry,
    second: GoalEntry,
    colour: str,
    *,
    best: bool,
) -> None:
    marker = 's' if colour == _BEFORE else 'o'
    ours = _place(entry.development, first, second)
    theirs = _place(entry.held_out, first, second)
    if ours is None:
        return
    x, y = ours
    if theirs:
        axes.plot([x, theirs[0]], [y, theirs[1]], color=_HELD, linewidth=0.8)
        axes.scatter(
            [theirs[0]], [theirs[1]], s=36, marker=marker, facecolors='none', edgecolors=_HELD
        )
    axes.scatter([x], [y], s=36, marker=marker, color=colour, zorder=3)
    if best:
        axes.scatter([x], [y], s=110, facecolors='none', edgecolors=colour, zorder=3)


def _place(
    figures: Figures | None, first: GoalEntry, second: GoalEntry
) -> tuple[float, float] | None:
    values = figures.objectives if figures else {}
    x, y = values.get(first.name), values.get(second.name)
    return None if x is None or y is None else (x, y)


def _limit(axes: 'Axes', result: TuningResult, first: GoalEntry, second: GoalEntry) -> None:
    """Leave out what is far from the front, which would press it into a corner."""
    drawn = [*result.front, *([result.before] if result.before else [])]
    for goal, setting in ((first, axes.set_xlim), (second, axes.set_ylim)):
        values = [
            value
            for entry in drawn
            for figures in (entry.development, entry.held_out)
            if figures and (value := figures.objectives[goal.name]) is not None
        ]
        low, high = min(values), max(values)
        span = (high - low) or abs(high) or 1.0
        bounds = axes.dataLim
        ends = (bounds.x0, bounds.x1) if goal is first else (bounds.y0, bounds.y1)
        margin = 0.06 * span
        setting(
            max(low - _SPREAD * span, ends[0]) - margin,
            min(high + _SPREAD * span, ends[1]) + margin,
        )


def convergence_figure(result: TuningResult, goal: GoalEntry) -> 'Figure':
    """Return the best value of an objective so far over the number of trials."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=_SIZE)
    axes = figure.subplots()
    values = np.array(result.convergence[goal.name], dtype=float)
    axes.plot(np.arange(1, len(values) + 1), values, drawstyle='steps-post', color=_FRONT)
    axes.set_xlabel('trials')
    axes.set_ylabel(f'best {_label(goal)}')
    return figure


def sensitivity_figure(
    result: TuningResult, trials: Sequence[TrialEntry], goal: GoalEntry
) -> 'Figure':
    """Return the value of an objective over each parameter, a panel for each."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, NullFormatter

    names = list(result.parameters)
    across = min(2, len(names))
    rows = -(-len(names) // across)
    figure = Figure(figsize=(_SIZE[0], 0.6 + 2.1 * rows))
    panels = figure.subplots(rows, across, squeeze=False, sharey=True)
    values = [each.objectives[goal.name] for each in trials]
    kept = np.array([each.state == FEASIBLE for each in trials], dtype=bool)
    known = np.array([value is not None for value in values], dtype=bool)
    heights = np.array([np.nan if value is None else value for value in values])
    for axes, name in zip(panels.flat, names, strict=False):
        tried = np.array([each.parameters[name] for each in trials], dtype=float)
        for chosen, colour in ((known & ~kept, _TRIED), (known & kept, _FRONT)):
            axes.scatter(tried[chosen], heights[chosen], s=8, color=colour)
        axes.set_xlabel(name, fontsize=9)
        if result.parameters[name].scale == LOG:
            axes.set_xscale('log')
            axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0), numticks=4))
            axes.xaxis.set_major_formatter('{x:g}')
            axes.xaxis.set_minor_formatter(NullFormatter())
    if known.any():
        low, high = np.nanmin(heights), np.nanquantile(heights, 0.9)
        margin = 0.08 * ((high - low) or 1.0)
        panels[0, 0].set_ylim(low - margin, high + margin)
    for axes in panels[:, 0]:
        axes.set_ylabel(_label(goal), fontsize=9)
    for axes in panels.flat[len(names) :]:
        axes.set_axis_off()
    return figure


def _label(goal: GoalEntry) -> str:
    unit = unit_text(goal.unit)
    return f'{goal.title}, {unit}' if unit else goal.title
