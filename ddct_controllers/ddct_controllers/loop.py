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

from ddct_controllers.architecture import AskedRequest, TorqueRequest, make_architecture
from ddct_controllers.handover.interface import HandoverCommand, HandoverMeasurement
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


class ObservedStep(NamedTuple):
    """A step before anything is requested of its clutch and engine."""

    observation: Observation
    """What a controller receives of the plant."""
    handover: HandoverCommand | None
    """Command of the handover for the period; None without a shift."""
    on_coming: OnComingShare
    """Share in C_fOL of the clutch whose torque is requested."""


class AskedStep(NamedTuple):
    """A step of which the controller has the measurement, and has not answered it."""

    measurement: Measurement
    """Measured signals and the slip reference."""
    asked: AskedRequest
    """Request of the architecture without the feedback."""


class PlantLoop(ABC):
    """The plant of a run and its handover, stepped by the requests of a class below this one."""

    def __init__(self, settings: RunSettings, *, two_input: bool = False) -> None:
        """Start in the run's initial state; `two_input`: the engine's torque is requested too."""
        self.plant = Plant(settings, two_input=two_input)
        self._handover = make_handover(settings.known) if settings.shift else None
        self._last: PlantReply | None = None

    @abstractmethod
    def request(self, observed: ObservedStep) -> Request:
        """Return what is requested at a step."""

    def observe(self, step: int) -> ObservedStep:
        """Return the plant at step k, with the command of the handover."""
        tick = self.plant.tick(step)
        if self._handover is None:
            return ObservedStep(self.plant.observe(tick), None, WHOLE)
        command = self._handover.update(HandoverMeasurement.of_tick(tick))
        observation = self.plant.observe(tick, command.torque_cut)
        return ObservedStep(observation, command, command.on_coming)

    def answer(self, observed: ObservedStep, request: Request) -> PlantReply:
        """Return torques and every signal of an observed step; advance all but the plant."""
        observation, command, _ = observed
        if command is None:
            reply = self.plant.reply(observation, request.torque, request.engine_torque)
        else:
            reply = self.plant.reply(
                observation, request.torque, request.engine_torque, command.off_going_request
            )
            reply.signals.update(command.signals)
        reply.signals.update(request.signals)
        self._last = reply
        return reply

    def reply(self, step: int) -> PlantReply:
        """Return torques and every signal of step k; advance all but the plant."""
        observed = self.observe(step)
        return self.answer(observed, self.request(observed))

    def advance(self, reply: PlantReply) -> None:
        """Integrate the driveline over the period that `reply` answered."""
        self.plant.advance(reply)

    def steps(self, last: int) -> Iterator[ObservedStep]:
        """
        Yield each step from t_0 to t_`last`, or until the engine ends the run.

        `answer` has to be called with each before the next is taken.
        """
        yield self.observe(0)
        for step in range(1, last + 1):
            assert self._last is not None, 'the step before is answered'
            self.advance(self._last)
            yield self.observe(step)
            if self.plant.over:
                break

    def replies(self, steps: int) -> Iterator[PlantReply]:
        """Yield the reply of each step from t_0 to t_`steps`, or until the engine ends the run."""
        for observed in self.steps(steps):
            yield self.answer(observed, self.request(observed))


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

    def request(self, observed: ObservedStep) -> Request:
        """Return what the architecture requests at a step."""
        measurement = self._measurement(observed)
        started = time.perf_counter()
        request = self.architecture.update(measurement, observed.on_coming)
        self.update_time_us = 1e6 * (time.perf_counter() - started)
        return _with_signals(request, measurement)

    def ask(self, observed: ObservedStep) -> AskedStep:
        """Return what the controller is asked at a step; `requested` takes its answer."""
        measurement = self._measurement(observed)
        return AskedStep(measurement, self.architecture.ask(measurement, observed.on_coming))

    def requested(self, step: AskedStep) -> Request:
        """Return what `request` does, for a step of which the controller has been asked."""
        return _with_signals(self.architecture.answered(step.asked), step.measurement)

    def _measurement(self, observed: ObservedStep) -> Measurement:
        """Change the gains of a step, and return what is measured, with the slip reference."""
        observation, _, on_coming = observed
        step, measured = observation.tick.step, observation.tick.measured
        if step in self._changes:
            self.architecture.change_gains(self._changes[step])
        speeds, rates = self._reference.update(
            step, measured.slip_speed, measured.shaft_speed, on_coming.share
        )
        return Measurement.of_plant(observation, speeds, rates)


def _with_signals(request: TorqueRequest, measurement: Measurement) -> Request:
    signals: dict[str, SignalValue] = {
        'slip_reference': measurement.slip_reference,
        'slip_reference_rate': measurement.slip_reference_rate,
        'status': request.status,
        **request.parts,
    }
    return Request(request.torque, request.engine_torque, signals)
