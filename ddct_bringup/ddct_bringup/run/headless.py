"""
Run the closed loop without ROS.

    from ddct_bringup.run.headless import run_headless
    trajectory = run_headless(RunSettings(load_scenario('thesis')), 'pi')

The result equals that of the graph, in any process layout, to the last bit.
"""

import time

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.closed_loop import ClosedLoop
from ddct_bringup.run.run_timing import RunTiming
from ddct_controllers.interface import Controller
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.settings import RunSettings


def run_headless(
    settings: RunSettings, controller: str | Controller, timing: RunTiming | None = None
) -> Trajectory:
    """
    Simulate one run from t_0 to t_N and return every signal; fill `timing` if it is given.

    `controller` is a registry name or an object. Raise ParameterError for what cannot be built,
    DdctError when a controller commands a value that is not finite.
    """
    if isinstance(controller, str):
        controller = make_controller(controller, settings)
    return run_loop(ClosedLoop(settings, controller), settings.scenario.steps, timing)


def run_loop(loop: ClosedLoop, steps: int, timing: RunTiming | None = None) -> Trajectory:
    """Simulate a loop that is at t_0 up to t_`steps`; as `run_headless` otherwise."""
    timing = RunTiming() if timing is None else timing
    started = time.perf_counter()
    rows = [loop.reply(0)]
    timing.update_times_us.append(loop.update_time_us)
    for step in range(1, steps + 1):
        loop.advance(rows[-1])
        rows.append(loop.reply(step))
        timing.update_times_us.append(loop.update_time_us)
    timing.steps = steps
    timing.wall_time_s = time.perf_counter() - started
    present = [name for name, first in rows[0].items() if first is not None]
    return Trajectory.of_columns({name: [row[name] for row in rows] for name in present})
