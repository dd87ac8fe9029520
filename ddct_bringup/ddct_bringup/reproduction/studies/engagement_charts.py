"""Charts of many engagements: the slip of each controller in a panel of its own, with states."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ddct_bringup.verdict.state import ENGAGED
from ddct_controllers.design.drawing.chart_style import BLACK, BLUE, GREY, VERMILLION
from ddct_plant.base.timebase import PERIOD_S, time_of_step

COLUMNS = 5
PANEL_INCHES = (2.2, 1.45)
DOTS_PER_INCH = 58.0
"""Keeps a chart below 150 kB."""
MARGIN = 0.15
"""Beyond the slips of the runs that engage; what goes further leaves the panel."""
_COLOURS = (VERMILLION, BLACK, BLUE)


@dataclass(frozen=True, eq=False)
class Slip:
    """The slip of one run, and the state that it was given."""

    controller: str
    label: str
    """Its wear gain, which tells it from other runs of the controller."""
    state: str
    start: int
    """Step at which control starts."""
    rpm: np.ndarray
    """(N+1,)."""


def engagement_chart(title: str, slips: Sequence[Slip]) -> Figure:
    """Return a panel per controller with all its runs over time in s, each state in it."""
    by_name = sorted(slips, key=lambda slip: _place(slip, slips))
    panels = [list(group) for _, group in groupby(by_name, key=lambda slip: slip.controller)]
    rows = math.ceil(len(panels) / COLUMNS)
    size = (COLUMNS * PANEL_INCHES[0], rows * PANEL_INCHES[1])
    figure = Figure(figsize=size, dpi=DOTS_PER_INCH)
    figure.suptitle(f'{title}: w_d in rpm over s; control starts at the grey line')
    all_axes = figure.subplots(rows, COLUMNS, squeeze=False, sharex=True, sharey=True).flat
    for axes, panel in zip(all_axes, panels, strict=False):
        _draw(axes, panel)
    for axes in figure.axes[len(panels) :]:
        axes.set_axis_off()
    first = figure.axes[0]
    first.set_ylim(*_range(slips))
    first.set_xlim(0.0, time_of_step(max(len(slip.rpm) for slip in slips) - 1))
    return figure


def _place(slip: Slip, slips: Sequence[Slip]) -> int:
    return [other.controller for other in slips].index(slip.controller)


def _draw(axes: Axes, panel: Sequence[Slip]) -> None:
    axes.set_title(panel[0].controller, fontsize=9.0)
    axes.tick_params(labelsize=7.0)
    axes.set_xlabel('Time, s', visible=False)  # for the data; the title says it to the eye
    axes.set_ylabel('w_d, rpm', visible=False)
    axes.axvline(time_of_step(panel[0].start), color=GREY, linewidth=0.8)
    for place, (slip, colour) in enumerate(zip(panel, _COLOURS, strict=True)):
        time = np.arange(len(slip.rpm)) * PERIOD_S
        axes.plot(time, slip.rpm, label=f'K_usura {slip.label}', color=colour, linewidth=1.1)
        axes.text(
            0.98,
            0.96 - 0.13 * place,
            f'{slip.label} {slip.state}',
            transform=axes.transAxes,
            color=colour,
            fontsize=7.5,
            horizontalalignment='right',
            verticalalignment='top',
            bbox={'facecolor': 'white', 'alpha': 0.75, 'edgecolor': 'none', 'pad': 0.5},
        )


def _range(slips: Sequence[Slip]) -> tuple[float, float]:
    """Return the rpm that the panels show: those of the engaged runs, of all if none is."""
    shown = [slip.rpm for slip in slips if slip.state == ENGAGED] or [slip.rpm for slip in slips]
    low, high = min(rpm.min() for rpm in shown), max(rpm.max() for rpm in shown)
    margin = MARGIN * (high - low)
    return float(low - margin), float(high + margin)
