# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of runs, of campaigns and of the thesis, for notebooks, papers and slides."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ddct_bringup.api.result import Run, as_runs
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign_report.distributions_chart import distributions_chart
from ddct_bringup.campaign_report.folder import scenario_of
from ddct_bringup.campaign_report.reading import grouped_rows, read_table
from ddct_bringup.documents.chart import Chart, ChartAxis, Line, Panel
from ddct_bringup.documents.chart_files import matplotlib_figure
from ddct_bringup.documents.palette import looks
from ddct_bringup.report.chart_signals import ChartSignal
from ddct_bringup.report.charts import chart_signals_of
from ddct_bringup.report.run_labels import common_conditions, run_labels, varied_conditions
from ddct_bringup.reproduction.figures.command import collect_figures, require_drawn
from ddct_controllers.design.drawing.chart_style import chart_style, controllers_text
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import require_known
from ddct_plant.scenario.differences import scenario_title

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def figure(
    runs: Run | Iterable[Run], quantities: Sequence[str] = ('w_d', 'w_sr', 'A_x')
) -> 'Figure':
    """
    Return a figure of matplotlib with a chart per quantity over time, all runs in each.

    Its `savefig` writes PNG, SVG or PDF without a browser. The title names the controllers, the
    varied conditions and the common ones: scenario, architecture, clutch, wear gain. The
    quantities are the keys of the report's charts, such as w_d, error, w_sr, A_x, C_f_request;
    with a clutch that sticks also `temperature` and others. Raise ParameterError for another.
    """
    shown = as_runs(runs)
    if not shown or not quantities:
        raise ParameterError('a figure needs a run and a quantity')
    across = ChartAxis('time, s', (0.0, max(each.trajectory.time_s[-1] for each in shown)))
    panels = tuple(_panel(shown, key, across) for key in quantities)
    title, conditions = _title(shown)
    return matplotlib_figure(Chart(title, panels, conditions))


def campaign_figure(folder: str | Path) -> 'Figure':
    """
    Return the distributions of a finished campaign: a chart per metric, a curve per controller.

    A curve is the share of the valid runs that engaged with at most the value. Raise DdctError for
    a folder without a finished campaign.
    """
    recorded = RecordedCampaign.read(Path(folder))
    results = grouped_rows(recorded, read_table(Path(folder), recorded))
    return matplotlib_figure(distributions_chart(results, scenario_of(recorded)))


class ThesisDrawing(NamedTuple):
    """One figure of the thesis, drawn again."""

    figure: 'Figure'
    remark: str
    """What agrees with the thesis and what does not, as in docs/thesis/figures.md."""


def thesis_figure(number: str) -> ThesisDrawing:
    """
    Draw a figure of the thesis again, such as '2.26'.

    Raise ParameterError for a figure that the thesis does not have, or that cannot be drawn.
    """
    require_drawn(number)
    figures = {each.number: each for each in collect_figures()}
    require_known([number], figures, 'figure of the thesis')
    with chart_style():
        return ThesisDrawing(*figures[number].draw())


def _panel(runs: Sequence[Run], key: str, across: ChartAxis) -> Panel:
    """Return the panel of a quantity: a line for each run."""
    labels = run_labels([each.scores for each in runs])
    signals = [_signal(each, key) for each in runs]
    lines = (
        Line(each.trajectory.time_s, signal.values(each.trajectory), look, label)
        for each, signal, look, label in zip(runs, signals, looks(len(runs)), labels, strict=True)
    )
    return Panel(tuple(lines), across, ChartAxis(f'{key}, {signals[0].unit}'))


def _title(runs: Sequence[Run]) -> tuple[str, str]:
    """Return the title, controllers and varied conditions, and the common conditions."""
    scored = [run.scores for run in runs]
    names = dict.fromkeys(each.label for each in scored)
    scenarios = dict.fromkeys(
        scenario_title(each.scenario or 'no scenario', each.scenario_changes or ())
        for each in scored
    )
    varied = [key.replace('_', ' ') for key in varied_conditions(scored)]
    varied = ['scenario', *varied] if len(scenarios) > 1 else varied
    over = f' over {", ".join(varied)}' if varied else ''
    shared = ', '.join(common_conditions(scored))
    return f'{controllers_text(list(names))}{over}', f'{"; ".join(scenarios)}; {shared}'


def _signal(run: Run, key: str) -> ChartSignal:
    known = {quantity.key: quantity for quantity in chart_signals_of(run.trajectory)}
    require_known([key], known, 'quantity')
    return known[key]
