# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Build the page: one HTML file without external resources."""

from collections.abc import Sequence
from dataclasses import asdict

from markupsafe import Markup

from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.documents.bokeh_charts import PageCharts, library
from ddct_bringup.documents.page_parts import (
    DOCUMENTS,
    MARKER,
    json_data,
    page_part,
    page_template,
)
from ddct_bringup.documents.palette import NEUTRAL
from ddct_bringup.report.charts import charted_signals, dashed_lines, time_charts
from ddct_bringup.report.definitions import ShownParts, definitions
from ddct_bringup.report.evidence import COMPUTED, LoopEvidence, loop_rows, without_evidence
from ddct_bringup.report.front_view import front_view
from ddct_bringup.report.page_runs import PageRun, chart_runs, page_runs
from ddct_bringup.report.pareto import pareto_view
from ddct_bringup.report.pareto_chart import PARETO, pareto_chart, pareto_legend
from ddct_bringup.report.phase_lanes import LANES, OPACITY, SHIFT_OPACITY
from ddct_bringup.report.run_labels import common_conditions
from ddct_bringup.report.run_tables import TICKS, time_place
from ddct_bringup.report.score_tables import (
    figure_columns,
    limit_columns,
    other_columns,
    table_5_1_columns,
)
from ddct_bringup.run.description import short_commit
from ddct_bringup.scores.engine_cut import cut_note
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.scores.scored_run import YARDSTICK
from ddct_bringup.thesis.table_5_1 import PREDICTION_TOLERANCE
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.design.analysis.loop_quantities import LOOP_QUANTITIES
from ddct_plant.program.command_line import package_version
from ddct_plant.scenario.differences import scenario_title
from ddct_plant.scenario.file import scenario_to_yaml

_ROOM = 'ddct_bringup.report'
_STYLES = ((DOCUMENTS, 'page.css'), (DOCUMENTS, 'charts.css'), (_ROOM, 'page.css'))
_SCRIPTS = (
    (DOCUMENTS, 'page.js'),
    (DOCUMENTS, 'charts.js'),
    (_ROOM, 'nearest.js'),
    (_ROOM, 'page.js'),
)


def report_page(
    runs: Sequence[ScoredRecording], evidence: Sequence[LoopEvidence], limits: Limits
) -> str:
    """
    Return the HTML of a report on runs of one scenario, at least one of them readable.

    `limits` are those that judged them.
    """
    import bokeh

    shown = page_runs(runs)
    thesis_rows = [run.thesis for run in shown]
    charted = chart_runs(shown)
    charts = PageCharts()
    drawn = time_charts(charted, charts)
    front = front_view(runs, limits.rules)
    front_html = charts.add(front.chart(shown)) if front else None
    quantities = charted_signals(charted)
    pareto = pareto_view(runs)
    if pareto:
        charts.add_figure(f'chart-{PARETO}', pareto_chart(pareto, shown))
    data = {**charts.data, 'pareto': pareto and asdict(pareto)}
    recordings = _simulated_first(runs)
    settings = recordings[0].settings
    shift = any(run.scores.is_shift for run in runs)
    table_5_1, figures = table_5_1_columns(runs, thesis_rows), figure_columns(runs)
    further, limits_shown = other_columns(runs, table_5_1), limit_columns(runs)
    loops = loop_rows(evidence)
    parts = ShownParts(
        quantities,
        [column.metric for column in (*table_5_1, *figures, *further)],
        frozenset(run.scores.state.replace('_', ' ') for run in shown),
        frozenset(str(value) for run in shown for _, value in run.origin.conditions),
        thesis=any(thesis_rows),
        shift=shift,
        limits=bool(limits_shown),
        beyond=any(cell.beyond for column in limits_shown for cell in column.cells),
        yardstick=any(cell.yardstick for column in figures for cell in column.cells),
        loops=bool(loops),
        times=any(run.times for run in shown),
    )
    return page_template(_ROOM, 'page.html.j2').render(
        marker=Markup(MARKER),
        bokeh_js=library(),
        style=Markup().join(page_part(room, each) for room, each in _STYLES),
        script=Markup().join(page_part(room, each) for room, each in _SCRIPTS),
        data=json_data(data),
        quantities=quantities,
        definitions=definitions(parts),
        lanes=LANES if LANES in drawn else None,
        phases=OPACITY,
        limit_columns=limits_shown,
        limits=limits.origin,
        pareto=pareto,
        floor_front=front,
        front_html=front_html,
        pareto_place=f'chart-{PARETO}',
        pareto_legend=pareto_legend(shown),
        neutral=NEUTRAL,
        runs=shown,
        table_5_1=table_5_1,
        figures=figures,
        further=further,
        starred=parts.yardstick,
        yardstick=YARDSTICK,
        cut=cut_note({run.label: run.scores.engine_cut for run in shown if run.scores.engine_cut}),
        withheld=any(run.scores.metrics['torque_late_s'] for run in runs),
        shift=shift,
        shift_phases=SHIFT_OPACITY if shift else {},
        prediction_tolerance=PREDICTION_TOLERANCE,
        loop_columns=LOOP_QUANTITIES,
        loops=loops,
        no_loops=without_evidence(evidence),
        computed=COMPUTED,
        ticks=TICKS,
        time_place=time_place,
        short_commit=short_commit,
        facts=recordings[0].facts,
        scenario_title=_scenario_title(runs),
        conditions=common_conditions([run.scores for run in runs]),
        sensors=_sensors(runs),
        scenario_text=scenario_to_yaml(settings.scenario) if settings else '',
        dashed=dashed_lines(charted),
        other_times=_other_times(shown, recordings[0].facts),
        digest=next((run.digest for run in runs if run.digest), None),
        commits=sorted({run.origin.commit for run in shown if run.simulated}),
        versions=sorted({run.origin.version for run in shown if run.simulated}),
        made_with={'ddct_bringup': package_version(), 'Bokeh': bokeh.__version__},
    )


def _simulated_first(runs: Sequence[ScoredRecording]) -> list[Recording]:
    """Return the recordings, those of logs last: they have fewer facts of the scenario."""
    read = [run.recording for run in runs if run.recording is not None]
    return sorted(read, key=lambda each: each.measured)


def _other_times(shown: Sequence[PageRun], facts: RunFacts) -> list[tuple[str, RunFacts]]:
    """Return the labels and facts of runs with another control start or score window."""
    of_runs = [(run.label, run.recording.facts) for run in shown if run.recording]
    times = (facts.control_start_s, facts.score_window_s)
    return [
        (label, each)
        for label, each in of_runs
        if (each.control_start_s, each.score_window_s) != times
    ]


def _scenario_title(runs: Sequence[ScoredRecording]) -> str:
    """Return the common scenario of the readable runs with its changes."""
    readable = [run.scores for run in runs if run.recording is not None]
    changes = (run.scenario_changes for run in readable if run.scenario_changes)
    return scenario_title(readable[0].scenario or '', next(changes, ()))


def _sensors(runs: Sequence[ScoredRecording]) -> str | None:
    """Return the sensor keys of the scenario as text; None where control uses the true signals."""
    of_runs = (run.settings.scenario.sensors for run in runs if run.settings is not None)
    sensors = next(of_runs, None)
    return None if sensors is None else sensors.text
