# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The closed loop of a run, connected as in the graph: of one clutch, or of the two of a shift.

    loop = ClosedLoop(settings, controller)
    for reply in loop.replies(settings.scenario.steps):
        reply.signals['slip_speed']
"""

import time
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from ddct_controllers.architecture import make_architecture
from ddct_controllers.handover.interface import HandoverMeasurement
from ddct_controllers.handover.laws import make_handover
from ddct_controllers.interface import Controller, Measurement
from ddct_plant.plant import Observation, Plant, PlantReply
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.balance import WHOLE, OnComingShare
from ddct_plant.signals.gain_changes import GainChange
from ddct_plant.signals.topic import SignalValue
from ddct_reference.factory import make_reference
from ddct_reference.slip_reference import SlipReference


class Request(NamedTuple):
    """What is requested of the plant for a period, besides the off-going clutch of a shift."""

    torque: float
    """Of the clutch, in a shift of the on-coming one, N m."""
    engine_torque: float | None
    """Of the engine, N m; None where only the driver commands it."""
    signals: Mapping[str, SignalValue]
    """Signals of what requests it, by name."""


class PlantLoop(ABC):
    """The plant of a run and its handover, stepped by the requests of a class below this one."""

    def __init__(self, settings: RunSettings, *, two_input: bool = False) -> None:
        """Start in the run's initial state; `two_input`: the engine's torque is requested too."""
        self.plant = Plant(settings, two_input=two_input)
        self._handover = make_handover(settings.known) if settings.shift else None

    @abstractmethod
    def request(self, observation: Observation, on_coming: OnComingShare) -> Request:
        """Return what is requested at a step; `on_coming` has the clutch's share of C_fOL."""

    def reply(self, step: int) -> PlantReply:
        """Return torques and every signal of step k; advance all but the plant."""
        tick = self.plant.tick(step)
        if self._handover is None:
            observation = self.plant.observe(tick)
            request = self.request(observation, WHOLE)
            reply = self.plant.reply(observation, request.torque, request.engine_torque)
        else:
            command = self._handover.update(HandoverMeasurement.of_tick(tick))
            observation = self.plant.observe(tick, command.torque_cut)
            request = self.request(observation, command.on_coming)
            reply = self.plant.reply(
                observation, request.torque, request.engine_torque, command.off_going_request
            )
            reply.signals.update(command.signals)
        reply.signals.update(request.signals)
        return reply

    def advance(self, reply: PlantReply) -> None:
        """Integrate the driveline over the period that `reply` answered."""
        self.plant.advance(reply)

    def replies(self, steps: int) -> Iterator[PlantReply]:
        """Yield the reply of each step from t_0 to t_`steps`, or until the engine ends the run."""
        reply = self.reply(0)
        yield reply
        for step in range(1, steps + 1):
            self.advance(reply)
            reply = self.reply(step)
            yield reply
            if self.plant.over:
                break


class ClosedLoop(PlantLoop):
    """The loop of a run: plant, handover, reference and controller."""

    def __init__(
        self,
        settings: RunSettings,
        controller: Controller,
        reference: SlipReference | None = None,
        changes: Iterable[GainChange] = (),
    ) -> None:
        """
        Start in the run's initial state.

        `reference` takes the place of that of the run; each of the `changes` of the controller's
        gains acts from its step on.
        """
        super().__init__(settings, two_input=controller.commands_engine)
        self.kind = settings.kind(two_input=controller.commands_engine)
        """Kind of the run, which decides which signals it has."""
        self._reference = reference or make_reference(settings.known, controller.preview_steps)
        self.architecture = make_architecture(settings.known, controller)
        self._changes: dict[int, dict[str, float]] = {}
        for change in changes:
            self._changes.setdefault(change.step, {})[change.gain] = change.after
        self.update_time_us = 0.0
        """Wall time of the controller's last update, us."""

    def request(self, observation: Observation, on_coming: OnComingShare) -> Request:
        """Return what the architecture requests at a step."""
        step, measured = observation.tick.step, observation.tick.measured
        if step in self._changes:
            self.architecture.change_gains(self._changes[step])
        speeds, rates = self._reference.update(
            step, measured.slip_speed, measured.shaft_speed, on_coming.share
        )
        measurement = Measurement.of_plant(observation, speeds, rates)
        started = time.perf_counter()
        request = self.architecture.update(measurement, on_coming)
        self.update_time_us = 1e6 * (time.perf_counter() - started)
        signals: dict[str, SignalValue] = {
            'slip_reference': speeds,
            'slip_reference_rate': rates,
            'status': request.status,
            **request.parts,
        }
        return Request(request.torque, request.engine_torque, signals)
