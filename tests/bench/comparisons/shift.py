# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time per step of a gear shift without a graph: two clutches beside one."""

import time
from collections.abc import Iterator

from bench.comparisons.headless import step_s
from bench.peers.numpy_loop import LEAST_S
from bench.skeleton.comparison import Bench, Sides, comparison

from ddct_controllers.architecture import make_architecture
from ddct_controllers.handover.interface import HandoverMeasurement
from ddct_controllers.handover.laws import make_handover
from ddct_controllers.interface import Measurement
from ddct_controllers.registry import make_controller
from ddct_plant.models.clutch import STICK_SLIP
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift_plant.plant import ShiftPlant
from ddct_reference.factory import make_reference


def shift_settings() -> RunSettings:
    """Return the upshift from first to second gear at 20 km/h with 100 N m."""
    scenario = load_scenario('upshift', clutch=STICK_SLIP)
    return RunSettings(scenario, clutch=STICK_SLIP, handover='timed')


def shift_step_s(settings: RunSettings) -> float:
    """Return the processor time per step in s of a shift under PI, without its set-up."""
    elapsed, steps = 0.0, 0
    while elapsed < LEAST_S:
        plant, handover = ShiftPlant(settings), make_handover(settings)
        controller = make_controller('pi', settings)
        reference = make_reference(settings, controller.preview_steps)
        architecture = make_architecture(settings, controller)
        started = time.thread_time()
        for step in range(settings.scenario.steps):
            outputs = plant.outputs()
            now = outputs.driveline
            measured = HandoverMeasurement.of_plant(step, plant.demand(step), outputs)
            command = handover.update(measured)
            observation = plant.observe(step, outputs, command.torque_cut)
            speeds, rates = reference.update(step, now.slip_speed, now.shaft_speed)
            request = architecture.update(Measurement.of_plant(step, observation, speeds, rates))
            on_coming = command.share * request.torque
            reply = plant.reply(step, outputs, observation, on_coming, command.off_going_request)
            plant.advance(reply)
        elapsed += time.thread_time() - started
        steps += settings.scenario.steps
    return elapsed / steps


@comparison('headless step of a shift', 'a launch', at_most=1.6)
def shift_beside_launch(bench: Bench) -> Iterator[Sides]:
    """Processor time per step under PI: two clutches and a handover beside one clutch."""
    settings = shift_settings()
    yield Sides(lambda: shift_step_s(settings), lambda: step_s('pi', 'launch', STICK_SLIP))
