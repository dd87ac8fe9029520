# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The closed loops of many runs at once, the counterpart of `ClosedLoop`."""

from collections.abc import Hashable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.architectures import Architectures
from ddct_bringup.batch.controllers.interface import Measured
from ddct_bringup.batch.controllers.mixed import MixedControllers
from ddct_bringup.batch.handovers.choice import handover_kind, make_handovers
from ddct_bringup.batch.open_loops import open_loop_kind
from ddct_bringup.batch.plant.plants import Plants, plant_kind
from ddct_bringup.batch.recorder import Recorder
from ddct_bringup.batch.references import References, descent_kind
from ddct_bringup.batch.shift_references import ShiftReferences
from ddct_controllers.handover.interface import HandoverMeasurement
from ddct_controllers.interface import Controller
from ddct_plant.plant import Observation, PlantReply, Tick
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.balance import WHOLE, OnComingShare


class Stack(NamedTuple):
    """Simulated runs."""

    trajectory: Trajectory
    """Signals that scores need, with the R runs as their first axis; after `last` any values."""
    last: np.ndarray
    """Last step of each run, (R,); before its N where its engine ended it."""
    unsure: np.ndarray
    """Runs that must be computed step by step, (R,)."""
    fed: np.ndarray
    """Runs whose feedback has been on, (R,)."""


def loop_kind(settings: RunSettings) -> Hashable:
    """Return what runs share that are simulated together."""
    known = settings.known
    shift = (handover_kind(known), descent_kind(known)) if settings.shift else None
    return plant_kind(settings), open_loop_kind(known), shift


def simulate_batch(
    runs: Sequence[RunSettings],
    controllers: Sequence[Controller],
    feedback_factor: float = 1.0,
) -> Stack:
    """
    Return the signals of `run_headless` that scores need, of many runs with their controllers.

    All runs are of one `loop_kind`; the record ends with the longest. The feedback torques are
    multiplied by `feedback_factor`.
    """
    feedback = MixedControllers(controllers, [run.known for run in runs])
    ends = np.array([run.scenario.steps for run in runs])
    steps = int(ends.max())
    loops = _Loops(runs, feedback, steps, feedback_factor)
    plants = loops.plants
    recorder = Recorder(steps, len(runs), sticking=runs[0].stick_slip, shift=runs[0].shift)
    running, unsure = np.ones(len(runs), dtype=bool), np.zeros(len(runs), dtype=bool)
    last = ends.copy()
    for step in range(steps + 1):
        tick = plants.tick(step)
        reply = loops.reply(tick, running)
        recorder.record(step, reply.signals, plants.phase_events)
        over = running & (step == ends)
        if step:
            over |= running & plants.over(tick)
        if over.any():
            last[over], unsure[over] = step, plants.unsure[over]
            running = running & ~over
            if not running.any():
                break
        plants.advance(reply, running)
    return Stack(recorder.trajectory(), last, unsure, loops.fed)


class _Loops:
    """The loops of R runs of one kind: plants, handovers, references and controllers."""

    def __init__(
        self,
        runs: Sequence[RunSettings],
        feedback: MixedControllers,
        steps: int,
        feedback_factor: float,
    ) -> None:
        known = [run.known for run in runs]
        self.plants = Plants(runs, steps)
        self._architectures = Architectures(known, feedback, steps, feedback_factor)
        self._handovers = make_handovers(known) if runs[0].shift else None
        self._references: References | ShiftReferences
        references = ShiftReferences if runs[0].shift else References
        self._references = references(known, feedback.preview_steps, steps)

    @property
    def fed(self) -> np.ndarray:
        """Whether feedback has been on, (R,)."""
        return self._architectures.fed

    def reply(self, tick: Tick, running: np.ndarray) -> PlantReply:
        """Return torques and recorded signals of a step; advance all but the plants."""
        if self._handovers is None:
            observation = self.plants.observe(tick)
            request, signals = self._request(observation, running, WHOLE)
            reply = self.plants.reply(observation, request)
        else:
            now = HandoverMeasurement.of_tick(tick)
            load_torque = self._architectures.load_torque(now.step, now.vehicle_speed)
            command = self._handovers.update(now, load_torque)
            observation = self.plants.observe(tick, command.torque_cut)
            request, signals = self._request(observation, running, command.on_coming)
            reply = self.plants.reply(observation, request, command.off_going_request)
            reply.signals.update(command.signals)
        reply.signals.update(signals)
        return reply

    def _request(
        self, observation: Observation, running: np.ndarray, on_coming: OnComingShare
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Return the requests of the clutches, in a shift the on-coming ones, and signals."""
        tick = observation.tick
        slip_speed: Any = tick.measured.slip_speed
        share: Any = on_coming.share
        speeds, rates = self._references.update(tick.step, slip_speed, share)
        measured = Measured.of_plants(observation, speeds, rates)
        request = self._architectures.update(measured, running, on_coming)
        return request, {'slip_reference': speeds[:, 0]}
