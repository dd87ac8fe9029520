# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs as the page shows them: label, look of the line, scores and origin of each."""

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from ddct_bringup.bag.recording import Recording
from ddct_bringup.documents.palette import LineLook, looks, sample_svg
from ddct_bringup.report.chart_marks import ChartRun
from ddct_bringup.report.run_labels import run_labels
from ddct_bringup.report.run_tables import RunOrigin, UpdateTimes, run_origin, update_times
from ddct_bringup.report.score_tables import comparable_rows
from ddct_bringup.scores.run_notes import fallback_note
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.thesis.table_5_1 import ThesisRow
from ddct_plant.signals.gain_changes import changes_note

SHOWN_AT_FIRST = 12
"""
Largest number of runs of which all are visible at first; of more only those of Table 5.1, or the
first ones.
"""


@dataclass(frozen=True)
class PageRun:
    """One run as the template shows it."""

    index: int
    """Position in the report."""
    label: str
    look: LineLook
    sample: Markup
    """Line of its look as SVG."""
    scored: ScoredRecording
    on: bool
    """Whether its lines are visible at first."""
    thesis: ThesisRow | None
    """Row of Table 5.1 that it is comparable with."""
    times: UpdateTimes | None
    origin: RunOrigin

    @property
    def scores(self) -> ScoredRun:
        """Facts, state, metrics and limits."""
        return self.scored.scores

    @property
    def recording(self) -> Recording | None:
        """Recording; None where the bag cannot be read."""
        return self.scored.recording

    @property
    def charted(self) -> bool:
        """Whether it has signals."""
        return self.recording is not None

    @property
    def measured(self) -> bool:
        """Whether it is the log of a car."""
        return self.scored.measured

    @property
    def simulated(self) -> bool:
        """Whether it has signals of a simulation."""
        return self.charted and not self.measured

    @property
    def fallback(self) -> str:
        """Note on the steps of a controller without a solution; empty for none."""
        return fallback_note(self.scores) if self.scores.fallbacks else ''

    @property
    def changed_gains(self) -> str:
        """Note on gains that were changed while it ran; empty for none."""
        return changes_note(self.scores.gain_changes)


def page_runs(runs: Sequence[ScoredRecording]) -> list[PageRun]:
    """Return the runs for the template."""
    scored = [run.scores for run in runs]
    labels, on = run_labels(scored), _shown_at_first(runs)
    of_each = zip(runs, labels, looks(len(runs)), on, comparable_rows(runs), strict=True)
    return [
        PageRun(
            index=index,
            label=label,
            look=look,
            sample=sample_svg(look),
            scored=run,
            on=on,
            thesis=row,
            times=update_times(run),
            origin=run_origin(run),
        )
        for index, (run, label, look, on, row) in enumerate(of_each)
    ]


def chart_runs(shown: Sequence[PageRun]) -> list[ChartRun]:
    """Return the runs with signals for the charts."""
    return [
        ChartRun(
            index=run.index,
            label=run.label,
            look=run.look,
            trajectory=run.recording.trajectory,
            facts=run.recording.facts,
            shown=run.on,
            thesis_engagement_time_s=run.thesis.engagement_time_s if run.thesis else None,
        )
        for run in shown
        if run.recording is not None
    ]


def _shown_at_first(runs: Sequence[ScoredRecording]) -> list[bool]:
    if len(runs) <= SHOWN_AT_FIRST:
        return [True] * len(runs)
    of_table = [row is not None for row in comparable_rows(runs)]
    if 2 <= sum(of_table) <= SHOWN_AT_FIRST:
        return of_table
    return [index < SHOWN_AT_FIRST for index in range(len(runs))]
