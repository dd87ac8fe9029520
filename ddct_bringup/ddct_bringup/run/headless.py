# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Run the closed loop without ROS: one step at a time, the same classes as the nodes.

    from ddct_bringup.run.headless import run_headless
    trajectory = run_headless(RunSettings(KnownSettings(load_scenario('thesis'))), 'pi')

The result equals that of the graph, in any process layout, to the last bit.
"""

import time
from collections.abc import Sequence

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_controllers.interface import Controller
from ddct_controllers.linear import PiController
from ddct_controllers.loop import ClosedLoop
from ddct_controllers.registry import Chosen, compiled_code, make_controller, separately
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals.gain_changes import GainChange


def run_headless(
    settings: RunSettings,
    controller: Chosen | Controller,
    timing: RunTiming | None = None,
    changes: Sequence[GainChange] = (),
) -> Trajectory:
    """
    Simulate one run from t_0 to t_N and return every signal; fill `timing` if it is given.

    `controller` is a value that `make_controller` accepts, or an object; `changes` are gains that
    are changed in the run. Compiled code has a process of its own (`separately`), unless it is an
    object. Raise ParameterError for a loop that cannot be built, or for a gain that the
    controller does not take, DdctError when it commands a value that is not finite.
    """
    if not isinstance(controller, Controller):

        def work(chosen: Chosen) -> tuple[Trajectory, RunTiming]:
            found = RunTiming()
            return run_headless(
                settings, make_controller(chosen, settings.known), found, changes
            ), found

        build_first(settings, controller)
        trajectory, found = separately(controller, work)
        if timing is not None:
            vars(timing).update(vars(found))
        return trajectory
    loop = ClosedLoop(settings, controller, changes=changes)
    return run_loop(loop, settings.scenario.steps, timing)


def build_first(settings: RunSettings, chosen: Chosen) -> None:
    """Build a loop, so that not every process of compiled code imports and computes the same."""
    if compiled_code(chosen):
        ClosedLoop(settings, PiController(0.0, 0.0))


# What is not finite ends the run with a reason, so that numpy need not warn of it as well.
@np.errstate(over='ignore', invalid='ignore')
def run_loop(loop: ClosedLoop, steps: int, timing: RunTiming | None = None) -> Trajectory:
    """
    Simulate a loop from t_0 to t_`steps`, return every signal and fill `timing` if given.

    Raise DdctError when the controller commands a value that is not finite, or does not take a
    gain that is changed.
    """
    timing = RunTiming() if timing is None else timing
    started = time.perf_counter()
    rows = []
    for reply in loop.replies(steps):
        rows.append(reply.signals)
        timing.update_times_us.append(loop.update_time_us)
    timing.steps = len(rows) - 1
    timing.wall_time_s = time.perf_counter() - started
    return Trajectory.of_rows(rows, loop.kind)
