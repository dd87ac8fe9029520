# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The closed loop of a gear shift without ROS: plant, handover, reference and controller."""

import time
from typing import NamedTuple

from ddct_controllers.architecture import make_architecture
from ddct_controllers.handover.interface import Handover, HandoverCommand, HandoverMeasurement
from ddct_controllers.handover.laws import make_handover
from ddct_controllers.interface import Controller, Measurement
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.scenario.whole_plant import Observation
from ddct_plant.shift.driveline import ShiftOutputs
from ddct_plant.shift_plant.plant import ShiftPlant, ShiftReply
from ddct_reference.factory import make_reference


class HandoverTick(NamedTuple):
    """What comes before the request of the on-coming clutch at a step."""

    outputs: ShiftOutputs
    """True outputs of both sides."""
    command: HandoverCommand
    observation: Observation
    """Observation of the controller."""


def handover_tick(plant: ShiftPlant, handover: Handover, step: int) -> HandoverTick:
    """Return the command of the handover at step k, and what the controller observes with it."""
    outputs = plant.outputs()
    measured, off_going_slip = plant.measured(step, outputs)
    command = handover.update(
        HandoverMeasurement.of_speeds(step, plant.demand(step), measured, off_going_slip)
    )
    observation = plant.observe(step, outputs, measured, command.torque_cut)
    return HandoverTick(outputs, command, observation)


class ShiftLoop:
    """Closed loop of a shift, connected as in the graph; the handover replies to a tick first."""

    def __init__(self, settings: RunSettings, controller: Controller) -> None:
        """Start in the drive before the shift."""
        self.kind = settings.kind(two_input=controller.commands_engine)
        """Kind of the run, which decides which signals it has."""
        self.plant = ShiftPlant(settings, two_input=controller.commands_engine)
        self._handover = make_handover(settings)
        self._reference = make_reference(settings, controller.preview_steps)
        self.architecture = make_architecture(settings, controller)
        self.update_time_us = 0.0
        """Wall time of the controller's last update, us."""

    def reply(self, step: int) -> ShiftReply:
        """Return torques and every signal of step k; advance all but the plant."""
        outputs, command, observation = handover_tick(self.plant, self._handover, step)
        measured = observation.measured
        speeds, rates = self._reference.update(
            step, measured.slip_speed, measured.shaft_speed, command.share
        )
        measurement = Measurement.of_plant(step, observation, speeds, rates)
        started = time.perf_counter()
        request = self.architecture.update(measurement, command.on_coming)
        self.update_time_us = 1e6 * (time.perf_counter() - started)
        reply = self.plant.reply(
            step,
            outputs,
            observation,
            request.torque,
            command.off_going_request,
            request.engine_torque,
        )
        reply.signals.update(
            slip_reference=speeds,
            slip_reference_rate=rates,
            status=request.status,
            **command.signals,
            **request.parts,
        )
        return reply

    def advance(self, reply: ShiftReply) -> None:
        """Integrate the driveline over the period that `reply` answered."""
        self.plant.advance(reply)
