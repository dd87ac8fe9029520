# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Run the closed loop without ROS: one step at a time, the same classes as the nodes.

    from ddct_bringup.run.headless import run_headless
    trajectory = run_headless(RunSettings(load_scenario('thesis')), 'pi')

The result equals that of the graph, in any process layout, to the last bit.
"""

import time
from collections.abc import Callable, Sequence
from typing import Protocol, TypeVar

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.shift_loop import ShiftLoop
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_controllers.architecture import Architecture, make_architecture
from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.linear import PiController
from ddct_controllers.registry import Chosen, compiled_code, make_controller, separately
from ddct_plant.plant import Plant, PlantReply
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals.gain_changes import GainChange
from ddct_plant.signals.signal import RunKind
from ddct_reference.factory import make_reference


class ClosedLoop:
    """Closed loop of plant, reference and controller, connected as in the graph."""

    def __init__(self, settings: RunSettings, controller: Controller) -> None:
        """Start in the run's initial state."""
        self.kind = settings.kind(two_input=controller.commands_engine)
        """Kind of the run, which decides which signals it has."""
        self.plant = Plant(settings, two_input=controller.commands_engine)
        self._reference = make_reference(settings, controller.preview_steps)
        self.architecture = make_architecture(settings, controller)
        self.update_time_us = 0.0
        """Wall time of the controller's last update, us."""

    def reply(self, step: int) -> PlantReply:
        """Return torques and every signal of step k; advance all but the plant."""
        tick = self.plant.tick(step)
        observation, measured = self.plant.observe(tick), tick.measured
        speeds, rates = self._reference.update(step, measured.slip_speed, measured.shaft_speed)
        measurement = Measurement.of_plant(observation, speeds, rates)
        started = time.perf_counter()
        request = self.architecture.update(measurement)
        self.update_time_us = 1e6 * (time.perf_counter() - started)
        reply = self.plant.reply(observation, request.torque, request.engine_torque)
        reply.signals.update(
            slip_reference=speeds,
            slip_reference_rate=rates,
            status=request.status,
            **request.parts,
        )
        return reply

    def advance(self, reply: PlantReply) -> None:
        """Integrate the driveline over the period that `reply` answered."""
        self.plant.advance(reply)


Result = TypeVar('Result')


class Loop(Protocol):
    """A closed loop that `run_loop` steps: that of one clutch, or of a shift."""

    kind: RunKind
    architecture: Architecture
    update_time_us: float

    @property
    def plant(self) -> Plant:
        """Plant of the run, which can end it by its engine."""

    def reply(self, step: int) -> PlantReply:
        """Return torques and every signal of step k; advance all but the plant."""

    def advance(self, reply: PlantReply) -> None:
        """Integrate the driveline over the period that `reply` answered."""


def run_headless(
    settings: RunSettings,
    controller: Chosen | Controller,
    timing: RunTiming | None = None,
    changes: Sequence[GainChange] = (),
) -> Trajectory:
    """
    Simulate one run from t_0 to t_N and return every signal; fill `timing` if it is given.

    `controller` is a value that `make_controller` accepts, or an object; `changes` are gains that
    are changed in the run. Compiled code has a process of its own (`separate_run`), unless it is
    an object. Raise ParameterError for a loop that cannot be built, or for a gain that the
    controller does not take, DdctError when it commands a value that is not finite.
    """
    if not isinstance(controller, Controller):

        def work(chosen: Chosen) -> tuple[Trajectory, RunTiming]:
            found = RunTiming()
            return run_headless(settings, make_controller(chosen, settings), found, changes), found

        trajectory, found = separate_run(settings, controller, work)
        if timing is not None:
            vars(timing).update(vars(found))
        return trajectory
    loop = closed_loop(settings, controller)
    return run_loop(loop, settings.scenario.steps, timing, changes)


def separate_run(
    settings: RunSettings, chosen: Chosen, work: Callable[[Chosen], Result]
) -> Result:
    """Return `separately(chosen, work)`, where `work` makes the controller and its run."""
    if compiled_code(chosen):
        # Built here once, so that not every process imports and computes the same again.
        closed_loop(settings, PiController(0.0, 0.0))
    return separately(chosen, work)


def closed_loop(settings: RunSettings, controller: Controller) -> Loop:
    """Return the loop of a run: that of one clutch, or of a shift."""
    return ShiftLoop(settings, controller) if settings.shift else ClosedLoop(settings, controller)


# What is not finite ends the run with a reason, so that numpy need not warn of it as well.
@np.errstate(over='ignore', invalid='ignore')
def run_loop(
    loop: Loop,
    steps: int,
    timing: RunTiming | None = None,
    changes: Sequence[GainChange] = (),
) -> Trajectory:
    """
    Simulate a loop from t_0 to t_`steps`, return every signal and fill `timing` if given.

    Each of the `changes` of gains acts from its step on. Raise DdctError when the controller
    commands a value that is not finite, or does not take a gain.
    """
    timing = RunTiming() if timing is None else timing
    by_step: dict[int, dict[str, float]] = {}
    for change in changes:
        by_step.setdefault(change.step, {})[change.gain] = change.after

    def reply_at(step: int) -> PlantReply:
        if step in by_step:
            loop.architecture.change_gains(by_step[step])
        return loop.reply(step)

    started = time.perf_counter()
    reply = reply_at(0)
    rows = [reply.signals]
    timing.update_times_us.append(loop.update_time_us)
    for step in range(1, steps + 1):
        loop.advance(reply)
        reply = reply_at(step)
        rows.append(reply.signals)
        timing.update_times_us.append(loop.update_time_us)
        if loop.plant.over:
            break
    timing.steps = len(rows) - 1
    timing.wall_time_s = time.perf_counter() - started
    return Trajectory.of_rows(rows, loop.kind)
