"""Carry out one planned run in its layout and leave its bag in a folder."""

import re
from collections.abc import Callable
from pathlib import Path

from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_bringup.processes.live_process import LiveView
from ddct_bringup.processes.node_processes import NodeProcesses
from ddct_bringup.processes.ros_domain import own_domain
from ddct_bringup.run.description import custom_data, run_info_of
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.run_timing import RunTiming
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError

WORK_FOLDER = 'work'
"""Scenario, parameters and logs of a run; of a run that ends well only logs with warnings stay."""
_WARNING = re.compile(rb'^\[(WARN|ERROR|FATAL)\]', re.MULTILINE)


def execute(
    plan: RunPlan,
    folder: Path,
    stopped: Callable[[], bool] = lambda: False,
    live: LiveView | None = None,
) -> None:
    """
    Run `plan` and write its bag and `timing.json` into the existing `folder`.

    A run of separate processes begins once `live` hears them.
    Raise DdctError with the reason when the run does not end well, KeyboardInterrupt when
    `stopped()` becomes true; what was recorded until then stays in the folder.
    """
    if plan.layout == 'headless':
        _execute_headless(plan, folder)
        return
    work = folder / WORK_FOLDER
    try:
        work.mkdir()
        with own_domain():
            if plan.layout == 'processes':
                _execute_processes(plan, folder, work, stopped, live)
            else:
                _execute_single_process(plan, folder, work, stopped)
        _keep_warnings(work)
    except OSError as error:
        raise DdctError(f'{error.filename or folder}: {error.strerror or error}') from error


def kept_logs(folder: Path) -> list[Path]:
    """Return the logs with warnings that a run has left in its bag's folder."""
    return sorted((folder / WORK_FOLDER).glob('*.log'))


def _keep_warnings(work: Path) -> None:
    """Remove all but the logs in which a node warns of something, and the folder if none does."""
    for path in work.iterdir():
        if path.suffix != '.log' or not _WARNING.search(path.read_bytes()):
            path.unlink()
    if not any(work.iterdir()):
        work.rmdir()


def _execute_processes(
    plan: RunPlan,
    folder: Path,
    work: Path,
    stopped: Callable[[], bool],
    live: LiveView | None,
) -> None:
    with NodeProcesses(work, plan.write_parameter_file(folder, work)) as processes:
        processes.start([node for node in GRAPH_NODES if node.name != 'recorder' or not live])
        if live:
            # Without its recorder the graph stays at t_0 and sends it again and again.
            live.wait_until_heard(stopped)
            processes.start([node for node in GRAPH_NODES if node.name == 'recorder'])
        try:
            processes.wait_for('driveline', stopped)
        finally:
            # The recorder goes last: it must hear what the others flush when they stop.
            processes.stop(lambda name: name != 'recorder')
            processes.stop(lambda name: name == 'recorder')
        processes.require_clean_end()


def _execute_single_process(
    plan: RunPlan, folder: Path, work: Path, stopped: Callable[[], bool]
) -> None:
    # The graph needs ROS installed and sourced; a headless run does not.
    from ddct_bringup.processes.single_process import run_single_process

    parameters = plan.node_parameters(folder, work)
    run_single_process(parameters, stopped)


def _execute_headless(plan: RunPlan, folder: Path) -> None:
    from ddct_bringup.bag.trajectory_bag import write_trajectory

    controller = make_controller(plan.controller, plan.settings)
    timing = RunTiming()
    trajectory = run_headless(plan.settings, controller, timing)
    run_info = run_info_of(plan.settings, plan.name, controller, plan.steps)
    data = custom_data(plan.settings, plan.name, plan.steps)
    write_trajectory(trajectory, folder, plan.name, data, run_info)
    timing.write(folder)
