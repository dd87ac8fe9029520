# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run as scripts and notebooks get it: its signals, figures, metrics and state."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ddct_bringup.api import shell
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.csv_text import score_row, signal_columns
from ddct_bringup.scores.document import figures_entry, run_entry
from ddct_bringup.scores.floors import with_least
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import LimitResult, Limits
from ddct_controllers.registry import Chosen
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import to_json
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True, repr=False)
class Run:
    """One run: simulated, recorded from the graph, or loaded from a bag."""

    scored: ScoredRecording
    """Scores of the run, its recording and its timing; the recording can be read."""
    chosen: Chosen
    """Controller, as the registry accepts it."""

    def __repr__(self) -> str:
        """Return one line on the run, which a notebook prints after a cell that ends with it."""
        facts = self.recording.facts
        counts = 'valid' if self.valid else f'not valid: {self.reason}'
        return (
            f'<Run of {self.controller}: {facts.scenario}, {facts.duration_s:g} s, wear gain '
            f'{facts.wear_gain:g}, {self.state}, {counts}>'
        )

    @property
    def recording(self) -> Recording:
        """Recording of the run: signals, facts and settings."""
        assert self.scored.recording is not None, 'only a readable bag is scored here'
        return self.scored.recording

    @property
    def scores(self) -> ScoredRun:
        """Facts, metrics, state and limits of the run."""
        return self.scored.scores

    @property
    def timing(self) -> RunTiming | None:
        """Wall-clock times and counts; None of a bag without `timing.json`."""
        return self.scored.timing

    @property
    def controller(self) -> str:
        """Name of the controller."""
        return self.recording.facts.controller

    @property
    def path(self) -> Path | None:
        """Path of the MCAP file; None of a run that was not kept."""
        return self.recording.path if self.recording.path.is_file() else None

    @property
    def settings(self) -> RunSettings:
        """Settings of the run; DdctError for a bag whose scenario this version cannot build."""
        if self.recording.settings is None:
            raise DdctError(f'{self.scores.bag}: its scenario cannot be built by this version')
        return self.recording.settings

    @property
    def trajectory(self) -> Trajectory:
        """Trajectory of the run: every signal as an array, all SI."""
        return self.recording.trajectory

    @property
    def entry(self) -> Mapping[str, Any]:
        """Entry of the run in `scores.json`."""
        entry: Mapping[str, Any] = to_json(run_entry(self.scores))
        return entry

    @property
    def figures(self) -> Mapping[str, float | bool | None]:
        """Figures of `scores.json` by name; None for an undefined one."""
        return figures_entry(self.scores)

    @property
    def metrics(self) -> Metrics:
        """Figures and further metrics of `scores.json` by name; None for an undefined one."""
        return self.scores.metrics

    @property
    def state(self) -> str:
        """State of the run, as in docs/use/judging.md: `engaged` is the only success."""
        return self.scores.state

    @property
    def why(self) -> str:
        """Reason of the state; empty where its name says all."""
        return self.scores.why

    @property
    def limits(self) -> tuple[LimitResult, ...]:
        """Metrics beside their limits."""
        return self.scores.limits

    @property
    def valid(self) -> bool:
        """Whether the run is valid: recorded as planned, and finite."""
        return self.scores.valid

    @property
    def reason(self) -> str:
        """Reason of a run that is not valid; empty for a valid one."""
        return self.scores.reason

    def dataframe(self) -> Any:
        """Return the signals as a pandas DataFrame: a row per 10 ms, indexed by `time_s`."""
        import pandas

        return pandas.DataFrame(signal_columns(self.trajectory)).set_index('time_s')

    def with_least(self, limits: Limits) -> 'Run':
        """Return the run with its peak jerk over the least of its case."""
        return replace(self, scored=with_least(self.scored, limits))

    def frequency(self) -> Any:
        """
        Return the controller's entry of `frequency.json`, a dict: margins of its sampled loop.

        Its `linear` is false, and the rest None, for a controller without a frequency response.
        Raise DdctError where the controller of a loaded run cannot be found here, or its
        `linear_model` cannot be used.
        """
        evidence = shell.frequency_evidence([self.chosen], self.settings)
        return to_json(evidence.controllers[0])


def table(runs: Run | Iterable[Run]) -> Any:
    """Return a pandas DataFrame with a row per run: its facts, metrics and state."""
    import pandas

    return pandas.DataFrame([score_row(each.scores) for each in as_runs(runs)])


def as_runs(runs: Run | Iterable[Run]) -> list[Run]:
    """Return a list of runs, also of a single run."""
    return [runs] if isinstance(runs, Run) else list(runs)
