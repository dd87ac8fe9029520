# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The closed loops of many runs at once, the counterpart of `ClosedLoop`."""

from collections.abc import Hashable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.architectures import Architectures
from ddct_bringup.batch.controllers import Feedback, Measured
from ddct_bringup.batch.open_loops import open_loop_kind
from ddct_bringup.batch.plants import Plants, plant_kind
from ddct_bringup.batch.recorder import Recorder
from ddct_bringup.batch.references import References, reference_kind
from ddct_plant.scenario.settings import RunSettings


class Stack(NamedTuple):
    """Simulated runs."""

    trajectory: Trajectory
    """Signals that scores need, with the R runs as their first axis; after `last` any values."""
    last: np.ndarray
    """Last step of each run, (R,); before N where its engine ended it."""
    unsure: np.ndarray
    """Runs that must be computed step by step, (R,)."""
    fed: np.ndarray
    """Runs whose feedback has been on, (R,)."""


def loop_kind(settings: RunSettings) -> Hashable:
    """Return what runs share that are simulated together."""
    scenario, known = settings.scenario, settings.known
    return (
        plant_kind(settings),
        scenario.equilibrium,
        open_loop_kind(known),
        known.scenario.closing is not None,
        reference_kind(known),
    )


def simulate_batch(
    runs: Sequence[RunSettings],
    controllers: Feedback,
    preview_steps: int = 0,
    feedback_factor: float = 1.0,
) -> Stack:
    """
    Return the signals of `run_headless` that scores need, of many runs.

    All runs are of one `loop_kind`. Their controllers look at most `preview_steps` ahead.
    The feedback torques are multiplied by `feedback_factor`.
    """
    known, steps = [run.known for run in runs], runs[0].scenario.steps
    plants = Plants(runs, steps)
    references = References(known, preview_steps, steps)
    architectures = Architectures(known, controllers, steps, feedback_factor)
    recorder = Recorder(steps, len(runs), sticking=runs[0].stick_slip)
    running, last = np.ones(len(runs), dtype=bool), np.full(len(runs), steps)
    for step in range(steps + 1):
        tick = plants.tick(step)
        observation = plants.observe(tick)
        slip_speed: Any = tick.measured.slip_speed
        speeds, rates = references.update(step, slip_speed)
        measured = Measured.of_plants(observation, speeds, rates)
        reply = plants.reply(observation, architectures.update(measured, running))
        signals = {**reply.signals, 'slip_reference': speeds[:, 0]}
        recorder.record(step, signals, plants.phase_events)
        if step:
            over = running & plants.over(tick)
            last[over], running = step, running & ~over
        if not running.any():
            break
        plants.advance(reply, running)
    return Stack(recorder.trajectory(), last, plants.unsure, architectures.fed)
