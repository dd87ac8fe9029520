# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The closed loops of many runs at once, the counterpart of `ClosedLoop`."""

from collections.abc import Hashable, Sequence
from typing import Any

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.architectures import Architectures
from ddct_bringup.batch.controllers import Measured, StackedController
from ddct_bringup.batch.plants import Plants
from ddct_bringup.batch.recorder import Recorder
from ddct_bringup.batch.references import References, reference_kind
from ddct_plant.scenario.settings import RunSettings


def loop_kind(settings: RunSettings) -> Hashable:
    """Return what runs share that are simulated together."""
    scenario, known = settings.scenario, settings.known
    return (
        scenario.steps,
        (scenario.equilibrium, known.scenario.equilibrium),
        known.architecture,
        reference_kind(known),
        known.scenario.actuator.delay_substeps,  # it gives the order of the feedforward
    )


def simulate_batch(
    runs: Sequence[RunSettings],
    controllers: StackedController,
    preview_steps: int = 0,
    feedback_factor: float = 1.0,
) -> Trajectory:
    """
    Return the signals of `run_headless` that scores need, with the runs as their first axis.

    All runs are of one `loop_kind`, and their controllers of one kind with these preview steps.
    The feedback torques are multiplied by `feedback_factor`.
    """
    known, steps = [run.known for run in runs], runs[0].scenario.steps
    plants = Plants(runs, steps)
    references = References(known, preview_steps, steps)
    architectures = Architectures(known, controllers, steps, feedback_factor)
    recorder = Recorder(steps, len(runs))
    for step in range(steps + 1):
        tick = plants.tick(step)
        observation = plants.observe(tick)
        slip_speed: Any = tick.measured.slip_speed
        speeds, rates = references.update(step, slip_speed)
        request = architectures.update(Measured.of_plants(observation, speeds, rates))
        reply = plants.reply(observation, request)
        recorder.record(step, {**reply.signals, 'slip_reference': speeds[:, 0]})
        plants.advance(reply)
    return recorder.trajectory()
