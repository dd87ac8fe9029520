# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Run controllers from Python or load bags; signals, metrics and verdict of a run."""

import tempfile
import threading
import warnings
from collections.abc import Iterable, Mapping
from contextlib import nullcontext
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.bag.reader import Recording, read_bag
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.writer import bag_file
from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.processes.warm_parent import WarmParent
from ddct_bringup.run.execution import execute, parent_for
from ddct_bringup.run.output_folder import run_folder
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.run_base import RunBase
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.csv_text import score_row, signal_columns
from ddct_bringup.scores.document import run_entry, verdict_entry
from ddct_bringup.scores.floors import NONE, floor_metrics, scores_with_floors
from ddct_bringup.scores.scored_recording import (
    ScoredRecording,
    run_and_score,
    score_recording,
    simulate_and_score,
)
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limits, load_limits
from ddct_controllers.from_python import chosen_from
from ddct_controllers.registry import (
    Chosen,
    controller_label,
    controller_names,
    working_controllers,
)
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_controllers.workflows.evidence_types import ControllerEntry
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.options import options_of, require_known
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.settings import RunSettings

_ONE_GRAPH = threading.Lock()
"""Lock of the one graph of this process: its ROS domain is in the environment of all threads."""


@dataclass(frozen=True, repr=False)
class Run:
    """One run: simulated, recorded from the graph, or loaded from a bag."""

    recording: Recording
    scores: ScoredRun
    """Facts, metrics and verdict of the run."""
    timing: RunTiming | None
    """Wall-clock times and counts; None of a bag without `timing.json`."""
    chosen: Chosen
    """Controller, as the registry accepts it."""

    def __repr__(self) -> str:
        """Return one line on the run, which a notebook prints after a cell that ends with it."""
        facts = self.recording.facts
        counts = 'valid' if self.valid else f'not valid: {self.reason}'
        verdict = self.scores.verdict
        return (
            f'<Run of {self.controller}: {facts.scenario}, {facts.duration_s:g} s, wear gain '
            f'{facts.wear_gain:g}, {verdict.state}, limits {verdict.limits}, '
            f'{counts}>'
        )

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
        return run_entry(self.scores)

    @property
    def metrics(self) -> Metrics:
        """Metrics of `scores.json` by name; None for an undefined one."""
        return self.scores.metrics

    @property
    def verdict(self) -> Mapping[str, Any]:
        """Verdict with `state`, `limits` and `criteria`, as in docs/use/verdict.md."""
        return verdict_entry(self.scores.verdict)

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
        return pandas_module().DataFrame(signal_columns(self.trajectory)).set_index('time_s')

    @property
    def over_floor(self) -> Mapping[str, float | None]:
        """Metric over the least at the run's own lock time, by name; None where it has none."""
        return self.scores.over_floor

    def with_floors(self, metrics: Iterable[str] | None, limits: Limits) -> 'Run':
        """Return the run with the floors of metrics beside its scores; itself for None."""
        if metrics is None or self.recording.settings is None:
            return self
        settings, run = self.recording.settings, self.recording.trajectory
        scores = scores_with_floors(self.scores, settings, run, tuple(metrics), limits)
        return replace(self, scores=scores)

    def frequency(self) -> ControllerEntry:
        """
        Return the controller's entry of `frequency.json`: margins of its sampled loop.

        Its `linear` is false, and the rest None, for a controller without a frequency response.
        Raise DdctError where the controller of a loaded run cannot be found here.
        """
        return frequency_evidence([self.chosen], self.settings)['controllers'][0]


def run(
    controller: Any = 'pi',
    *,
    name: str = '',
    scenario: str | Path = 'thesis',
    set: Mapping[str, Any] | None = None,
    duration: float | None = None,
    headless: bool = True,
    out: str | Path | None = None,
    overwrite: bool = False,
    limits: str | Path | None = None,
    floors: str | Iterable[str] = NONE,
    beside: Iterable[str] = (),
    **settings: Any,
) -> Run:
    """
    Run one controller in the closed loop and judge the run.

    `controller` and `name` are the arguments of `chosen_from`: a name, a file, a class, a factory,
    an object, a linear system. `set` changes scenario keys, as {'load.slope_rad': 0.05}, the
    options of the controller among them, as {'controllers.NAME.KEY': value}. `settings` are those
    of `RunSettings`: architecture, clutch, wear_gain, mode, seed. Without `headless` the ROS graph
    runs, each node a process. With `out` the bag is kept as `<out>/<name>/`; a run that is not
    valid, with its `reason`, is kept as `<out>/<name>.partial/`. `floors` names the metrics that
    are compared with the least that any controller could have, as --floors does: 'usual', 'all',
    or names; they take seconds the first time. `beside` names other controllers
    whose options `set` may hold too.
    """
    chosen = chosen_from(controller, name)
    ready = _ready([controller_label(chosen), *beside], scenario, set, duration, **settings)
    plan = RunPlan(ready, chosen, _layout(headless))
    judged_by, metrics = load_limits(limits), metrics_of_floors(floors)
    return _run(plan, out, judged_by, overwrite=overwrite).with_floors(metrics, judged_by)


def _layout(headless: bool) -> str:
    return 'headless' if headless else 'processes'


def _run(
    plan: RunPlan,
    out: str | Path | None,
    limits: Limits,
    parent: WarmParent | None = None,
    *,
    overwrite: bool,
) -> Run:
    """Return the judged run of a plan; `parent` forks its nodes, None starts one for this run."""
    if out is not None:
        return _kept(plan, Path(out), limits, parent, overwrite=overwrite)
    if plan.layout == 'headless':
        return _run_of(simulate_and_score(plan, limits), plan.controller)
    with tempfile.TemporaryDirectory(prefix='ddct-') as folder:
        scored = run_and_score(plan, Path(folder), limits, partial(_execute, parent=parent))
        return _run_of(scored, plan.controller)


def compare(
    controllers: Iterable[Any] | Mapping[str, Any],
    *,
    headless: bool = True,
    out: str | Path | None = None,
    overwrite: bool = False,
    limits: str | Path | None = None,
    floors: str | Iterable[str] = NONE,
    **options: Any,
) -> list[Run]:
    """
    Return a run of each controller, all with the same options of `run`.

    The keys of a mapping name its controllers. Text is parsed like the option of `ddct compare`:
    'pi,ls8', or 'all', which leaves out a third party's controller that cannot be built, with a
    warning.
    """
    if controllers == 'all':
        warn = partial(warnings.warn, stacklevel=3)
        controllers = working_controllers(_ready(controller_names(), **options), warn)
    chosen = controllers_from(controllers)
    ready = _ready([controller_label(each) for each in chosen], **options)
    layout, judged_by = _layout(headless), load_limits(limits)
    metrics = metrics_of_floors(floors)
    with parent_for(layout) as parent:
        runs = [
            _run(RunPlan(ready, each, layout), out, judged_by, parent, overwrite=overwrite)
            for each in chosen
        ]
    return [each.with_floors(metrics, judged_by) for each in runs]


def controllers_from(controllers: str | Iterable[Any] | Mapping[str, Any]) -> list[Chosen]:
    """
    Return controllers, given as for `compare`, as the registry accepts them.

    Raise ParameterError for none.
    """
    if isinstance(controllers, str):
        controllers = [name.strip() for name in controllers.split(',') if name.strip()]
    if isinstance(controllers, Mapping):
        chosen = [chosen_from(each, name) for name, each in controllers.items()]
    else:
        chosen = [chosen_from(each) for each in controllers]
    if not chosen:
        raise ParameterError('controllers is empty: name at least one')
    return chosen


def load(
    bag: str | Path, *, limits: str | Path | None = None, floors: str | Iterable[str] = NONE
) -> Run:
    """
    Return the run in a bag, given as its folder or .mcap file, scored with `limits`.

    `floors` is that of `run`.
    """
    path, judged_by = Path(bag), load_limits(limits)
    scored = score_recording(read_bag(path), path.as_posix(), judged_by)
    return _run_of(scored).with_floors(metrics_of_floors(floors), judged_by)


def metrics_of_floors(floors: str | Iterable[str]) -> tuple[str, ...] | None:
    """Return the metrics of the argument `floors`, None for no floors; raise ParameterError."""
    return floor_metrics(floors if isinstance(floors, str) else ','.join(floors))


def table(runs: Run | Iterable[Run]) -> Any:
    """Return a pandas DataFrame with a row per run: its facts, metrics and verdict."""
    return pandas_module().DataFrame([score_row(each.scores) for each in as_runs(runs)])


def as_runs(runs: Run | Iterable[Run]) -> list[Run]:
    """Return a list of runs, also of a single run."""
    return [runs] if isinstance(runs, Run) else list(runs)


def _ready(labels: list[str], *options: Any, **given: Any) -> RunSettings:
    """Return the settings of one run, or of runs, with the controllers called `labels`."""
    settings = base_from(labels, *options, **given).at()
    for line in settings.scenario.adjusted:
        warnings.warn(f'scenario {settings.scenario.name}: {line}', stacklevel=3)
    return settings


def base_from(
    labels: Iterable[str],
    scenario: str | Path = 'thesis',
    set: Mapping[str, Any] | None = None,
    duration: float | None = None,
    **given: Any,
) -> RunBase:
    """Return the common base of runs with the controllers called `labels`."""
    if not isinstance(set, Mapping | None):
        raise ParameterError(
            f"set is {set!r}: give keys and values, as {{'load.slope_rad': 0.05}}"
        )
    changes = dict(set or {}) if duration is None else {**(set or {}), 'duration_s': duration}
    require_known(sorted(given), options_of(RunSettings), 'option')
    return RunBase(
        ScenarioFile.read(str(scenario)),
        {key: plain(changes[key]) for key in changes},
        {key: plain(given[key]) for key in given},
        tuple(labels),
    )


def plain(value: Any) -> Any:
    """Return a number or list of numpy as Python's, which bags write as the same text."""
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def _kept(
    plan: RunPlan, out: Path, limits: Limits, parent: WarmParent | None, *, overwrite: bool
) -> Run:
    with run_folder(out, plan.name, overwrite=overwrite) as folder:
        scored = run_and_score(plan, folder.path, limits, partial(_execute, parent=parent))
        kept = _run_of(scored, plan.controller)
        if not kept.valid:
            return kept
        folder.commit()
    path = bag_file(folder.final, plan.name)
    return replace(kept, recording=replace(kept.recording, path=path))


def _execute(plan: RunPlan, folder: Path, parent: WarmParent | None) -> None:
    with nullcontext() if plan.layout == 'headless' else _ONE_GRAPH:
        execute(plan, folder, parent=parent)


def _run_of(scored: ScoredRecording, chosen: Chosen = '') -> Run:
    assert scored.recording is not None, 'only a readable bag is scored here'
    recording = scored.recording
    return Run(recording, scored.scores, scored.timing, chosen or recording.facts.controller)


def pandas_module() -> Any:
    """Return pandas, which is an extra; raise DdctError without it."""
    try:
        import pandas
    except ImportError as error:
        raise DdctError(f'a DataFrame needs pandas ({error}): pip install pandas') from error
    return pandas
