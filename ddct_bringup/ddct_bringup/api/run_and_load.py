# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Run controllers in the closed loop from Python, or load bags."""

import tempfile
import threading
import warnings
from collections.abc import Iterable, Mapping
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import Any

from ddct_bringup.api.arguments import planned, run_settings, warn_of_adjusted
from ddct_bringup.api.result import Run
from ddct_bringup.api.shell.kept_run import keep_run
from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.run.execution import execute
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scored_recording import (
    ScoredRecording,
    run_and_score,
    score_recording,
    simulate_and_score,
)
from ddct_bringup.verdict.limits import Limits, load_limits
from ddct_controllers.from_python import chosen_from
from ddct_controllers.registry import (
    Chosen,
    controller_label,
)

_ONE_GRAPH = threading.Lock()
"""Lock of the one graph of this process: its ROS domain is in the environment of all threads."""


def run(
    controller: Any = 'pi',
    *,
    name: str = '',
    scenario: str | Path | None = None,
    car: str | Path | None = None,
    drive: str | Path | None = None,
    set: Mapping[str, Any] | None = None,
    case: Mapping[str, Any] | None = None,
    duration: float | None = None,
    headless: bool = True,
    out: str | Path | None = None,
    overwrite: bool = False,
    limits: str | Path | None = None,
    floors: bool = False,
    beside: Iterable[str] = (),
    **settings: Any,
) -> Run:
    """
    Run one controller in the closed loop and judge the run.

    `controller` and `name` are the arguments of `chosen_from`: a name, a file, a class, a factory,
    an object, a linear system. `scenario`, `car` and `drive` are names or files; a car or drive
    takes the place of that of the scenario, by default `thesis`, and a drive without a scenario
    has the car `c635` unless another is given. `set` changes scenario keys, as
    {'load.slope_rad': 0.05}, the options of the controller among them, as
    {'controllers.NAME.KEY': value}; controllers know these values. `case` gives what the plant
    alone has, as {'vehicle.mass_kg': 1700}: keys of the car or the drive, wear gains, the seed.
    `settings` are architecture, mode and handover, and in short for the case wear_gain,
    off_going_wear_gain and seed. Without `headless` the ROS graph runs, each node a process. With
    `out` the bag is kept as `<out>/<name>/`; a run that is not valid, with its `reason`, is kept
    as `<out>/<name>.partial/`. With `floors` the peak jerk is compared with the least of its case,
    which takes a second the first time. `beside` names other controllers whose options `set` may
    hold too.
    """
    chosen = chosen_from(controller, name)
    ready = run_settings(
        [controller_label(chosen), *beside],
        scenario,
        set,
        duration,
        case,
        car=car,
        drive=drive,
        **settings,
    )
    warn_of_adjusted(ready.scenario)
    plan = RunPlan(ready, chosen, _layout(headless))
    judged_by = load_limits(limits)
    found = _run(plan, out, judged_by, overwrite=overwrite)
    return found.with_least(judged_by) if floors else found


def _layout(headless: bool) -> str:
    return 'headless' if headless else 'processes'


def _run(
    plan: RunPlan,
    out: str | Path | None,
    limits: Limits,
    *,
    overwrite: bool,
) -> Run:
    """Return the judged run of a plan."""
    if out is not None:
        kept = keep_run(plan, Path(out), limits, _execute, overwrite=overwrite)
        return _run_of(kept, plan.controller)
    if plan.layout == 'headless':
        return _run_of(simulate_and_score(plan, limits), plan.controller)
    with tempfile.TemporaryDirectory(prefix='ddct-') as folder:
        return _run_of(run_and_score(plan, Path(folder), limits, _execute), plan.controller)


def compare(
    controllers: Iterable[Any] | Mapping[str, Any],
    *,
    headless: bool = True,
    out: str | Path | None = None,
    overwrite: bool = False,
    limits: str | Path | None = None,
    floors: bool = False,
    **options: Any,
) -> list[Run]:
    """
    Return a run of each controller, all with the same options of `run`.

    The keys of a mapping name its controllers. Text is parsed like the option of `ddct compare`:
    'pi,ls8', or 'all', which leaves out a third party's controller that cannot be built, with a
    warning.
    """
    layout, judged_by = _layout(headless), load_limits(limits)
    warn = partial(warnings.warn, stacklevel=4)
    plans = planned(None if controllers == 'all' else controllers, layout, warn, **options)
    warn_of_adjusted(plans[0].settings.scenario)
    runs = [_run(plan, out, judged_by, overwrite=overwrite) for plan in plans]
    return [each.with_least(judged_by) for each in runs] if floors else runs


def load(bag: str | Path, *, limits: str | Path | None = None, floors: bool = False) -> Run:
    """
    Return the run in a bag, given as its folder or .mcap file, scored with `limits`.

    `floors` is that of `run`.
    """
    path, judged_by = Path(bag), load_limits(limits)
    scored = score_recording(read_bag(path), path.as_posix(), judged_by)
    found = _run_of(scored)
    return found.with_least(judged_by) if floors else found


def _execute(plan: RunPlan, folder: Path) -> Recording | None:
    with nullcontext() if plan.layout == 'headless' else _ONE_GRAPH:
        return execute(plan, folder)


def _run_of(scored: ScoredRecording, chosen: Chosen = '') -> Run:
    assert scored.recording is not None, 'only a readable bag is scored here'
    return Run(scored, chosen or scored.recording.facts.controller)
