# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Execute one planned run in its layout and write its bag into a folder."""

import re
import shutil
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from rich.console import Console

from ddct_bringup import processes
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.run_info import RunInfoOfNodes
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.trajectory_bag import write_trajectory
from ddct_bringup.processes.graph_nodes import (
    ALL_NODES,
    DRIVELINE,
    RECORDER,
    all_nodes,
    nodes_of,
)
from ddct_bringup.run.description import custom_data, run_info_of
from ddct_bringup.run.headless import build_first, run_loop
from ddct_bringup.run.plan import SIDES, RunPlan
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_controllers import workflows
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.from_file.fmu.unpacked import remove_left_folders
from ddct_controllers.loop import ClosedLoop
from ddct_controllers.registry import Chosen, compiled_code, make_controller, separately
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.domain import own_domain, sole_graph
from ddct_plant.program.signals import interrupted_by, stop_signals
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals.gain_changes import GainChange
from ddct_plant.signals.topics import CLOCK

WORK_FOLDER = 'work'
"""
Name of the folder for scenario, parameters and logs; a good run keeps only logs with warnings.
"""
_WARNING = re.compile(rb'^\[(WARN|ERROR|FATAL)\]', re.MULTILINE)


def run_with_progress(
    plan: RunPlan,
    folder: Path,
    label: str = '',
    live: 'processes.LiveView | None' = None,
) -> Recording | None:
    """
    `execute` a plan into `folder`; print its progress, the stability of its loop and its speed.

    Raise DdctError when the run does not end well, KeyboardInterrupt after SIGINT or SIGTERM.
    """
    _print_loop_summary(plan)
    scenario = plan.settings.scenario
    what = f'{label}{plan.name}: {scenario.duration_s:g} s of {scenario.name}'
    started = time.perf_counter()
    if interrupted_by():  # a module has dropped the interruption of its import
        raise KeyboardInterrupt
    with stop_signals() as stops, Console(file=sys.stderr).status(f'{what}, {plan.layout}'):
        recording = execute(plan, folder, lambda: bool(stops), live)
    if stops:
        # The signal came after the end of the run: whatever would follow is cancelled.
        raise KeyboardInterrupt
    elapsed = time.perf_counter() - started
    print(f'{what} in {elapsed:.1f} s ({plan.layout})', file=sys.stderr, flush=True)
    return recording


def execute(
    plan: RunPlan,
    folder: Path,
    stopped: Callable[[], bool] = lambda: False,
    live: 'processes.LiveView | None' = None,
) -> Recording | None:
    """
    Execute `plan` and write its bag and `timing.json` into the existing `folder`.

    Return what a headless run has recorded, which is in memory with the values that its bag has;
    None for a graph, of which the bag has to be read.

    A run of separate processes begins once `live` receives their topics.

    Raise DdctError with the reason when the run does not end well, KeyboardInterrupt when
    `stopped()` becomes true; what was recorded until then stays in the folder.
    """
    if plan.layout == 'headless':
        recording, timing = simulate(plan)
        path = write_trajectory(
            recording.trajectory, folder, plan.name, recording.custom_data, recording.run_info
        )
        timing.write(folder)
        return replace(recording, path=path)
    work = folder / WORK_FOLDER
    try:
        work.mkdir()
        clock = plan.names.resolved(CLOCK.resolved_name)
        with own_domain() as domain, sole_graph(domain, clock):
            if plan.layout == 'processes':
                _execute_processes(plan, folder, work, stopped, live)
            else:
                _execute_single_process(plan, folder, work, stopped)
        _keep_warnings(work)
    except OSError as error:
        raise DdctError(f'{error.filename or folder}: {error.strerror or error}') from error
    finally:
        remove_left_folders()  # that of an FMU which has ended its node
    return None


def _print_loop_summary(plan: RunPlan) -> None:
    """Print the loop analysis of a controller from a file on standard error."""
    if not isinstance(plan.controller, str) or not is_controller_file(plan.controller):
        return
    for line in workflows.loop_summary.loop_summary(plan.controller, plan.settings):
        print(line, file=sys.stderr, flush=True)


def kept_logs(folder: Path) -> list[Path]:
    """Return the paths of the logs that a run has left in the folder of its bag."""
    return sorted((folder / WORK_FOLDER).glob('*.log'))


def print_kept_logs(program: str, folders: Iterable[Path]) -> None:
    """Print on standard error where these run folders have logs: warnings, and of failed runs."""
    warned: list[str] = []
    failed: list[str] = []
    for folder in folders:
        logs = kept_logs(folder)
        if all(map(_warns, logs)):
            warned += map(str, logs)
        else:
            failed.append(f'{folder / WORK_FOLDER}')
    if warned:
        print(f'{program}: warnings are in {", ".join(warned)}', file=sys.stderr)
    if failed:
        print(f'{program}: logs of what failed are in {", ".join(failed)}', file=sys.stderr)


def _keep_warnings(work: Path) -> None:
    """Remove all files but logs with a node's warning, and the folder if none is left."""
    for folder in (work / name for name in SIDES):
        shutil.rmtree(folder, ignore_errors=True)
    for path in work.iterdir():
        if path.suffix != '.log' or not _warns(path):
            path.unlink()
    if not any(work.iterdir()):
        work.rmdir()


def _warns(log: Path) -> bool:
    """Return whether a node warned or failed in its log."""
    return bool(_WARNING.search(log.read_bytes()))


def _execute_processes(
    plan: RunPlan,
    folder: Path,
    work: Path,
    stopped: Callable[[], bool],
    live: 'processes.LiveView | None',
) -> None:
    arguments = plan.write_parameter_files(folder, work)
    with processes.Supervisor(work, arguments.of, stopped) as supervisor:
        nodes = nodes_of(shift=plan.settings.shift)
        supervisor.start([node for node in nodes if node is not RECORDER or not live])
        if live:
            # Without its recorder the graph stays at t_0 and publishes that tick repeatedly.
            supervisor.wait_until(live.receives, processes.RECEIVE_S)
            supervisor.start([RECORDER])
        try:
            supervisor.wait_for(DRIVELINE.path)
        finally:
            # The recorder stops last: it must receive what the others publish when they stop.
            supervisor.stop(lambda name: name != RECORDER.path)
            supervisor.stop(lambda name: name == RECORDER.path)
        supervisor.require_clean_end()


def _execute_single_process(
    plan: RunPlan, folder: Path, work: Path, stopped: Callable[[], bool]
) -> None:
    """Run all nodes in this process, or in one of their own where the controller may end it."""
    arguments, shift = plan.write_parameter_files(folder, work), plan.settings.shift
    whole = all_nodes(shift=shift)
    if not compiled_code(plan.controller):
        # They print here: warnings alone.
        given = [*arguments.of(whole), '--log-level', 'warn']
        processes.run_single_process(nodes_of(shift=shift), given, stopped)
        return
    with processes.Supervisor(work, arguments.of, stopped) as supervisor:
        supervisor.start([whole])
        supervisor.wait_for(ALL_NODES)


def simulate(plan: RunPlan, changes: Sequence[GainChange] = ()) -> tuple[Recording, RunTiming]:
    """
    Execute a headless `plan` in memory; return its recording and its timing.

    `changes` are gains that are changed in the run; raise DdctError for one that is not taken.

    No file exists at the recording's path.
    """

    def work(chosen: Chosen) -> tuple[RunInfoOfNodes, Trajectory, RunTiming]:
        controller, timing = make_controller(chosen, plan.settings.known), RunTiming()
        described = run_info_of(plan.settings, plan.name, controller, plan.steps)
        loop = ClosedLoop(plan.settings, controller, changes=changes)
        return described, run_loop(loop, plan.settings.scenario.steps, timing), timing

    build_first(plan.settings, plan.controller)
    described, trajectory, timing = separately(plan.controller, work)
    recording = replace(
        recording_in_memory(plan.settings, plan.name, trajectory),
        custom_data=custom_data(plan.settings, plan.name, plan.steps),
        run_info=described,
    )
    return recording, timing


def recording_in_memory(
    settings: RunSettings, controller: str, trajectory: Trajectory
) -> Recording:
    """Return the recording of a headless run with the facts that scoring needs, without a bag."""
    return Recording(
        path=Path(),
        trajectory=trajectory,
        facts=RunFacts.of(settings, controller, settings.scenario.steps),
        settings=settings,
    )
