# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The closed loop of a gear shift without ROS: plant, handover, reference and controller."""

import time

from ddct_controllers.architecture import make_architecture
from ddct_controllers.handover.interface import HandoverMeasurement
from ddct_controllers.handover.laws import make_handover
from ddct_controllers.interface import Controller, Measurement
from ddct_plant.plant import Plant, PlantReply
from ddct_plant.scenario.settings import RunSettings
from ddct_reference.factory import make_reference


class ShiftLoop:
    """Closed loop of a shift, connected as in the graph; the handover replies to a tick first."""

    def __init__(self, settings: RunSettings, controller: Controller) -> None:
        """Start in the drive before the shift."""
        self.kind = settings.kind(two_input=controller.commands_engine)
        """Kind of the run, which decides which signals it has."""
        self.plant = Plant(settings, two_input=controller.commands_engine)
        self._handover = make_handover(settings)
        self._reference = make_reference(settings, controller.preview_steps)
        self.architecture = make_architecture(settings, controller)
        self.update_time_us = 0.0
        """Wall time of the controller's last update, us."""

    def reply(self, step: int) -> PlantReply:
        """Return torques and every signal of step k; advance all but the plant."""
        tick = self.plant.tick(step)
        command = self._handover.update(HandoverMeasurement.of_tick(tick))
        observation, measured = self.plant.observe(tick, command.torque_cut), tick.measured
        speeds, rates = self._reference.update(
            step, measured.slip_speed, measured.shaft_speed, command.share
        )
        measurement = Measurement.of_plant(observation, speeds, rates)
        started = time.perf_counter()
        request = self.architecture.update(measurement, command.on_coming)
        self.update_time_us = 1e6 * (time.perf_counter() - started)
        reply = self.plant.reply(
            observation, request.torque, request.engine_torque, command.off_going_request
        )
        reply.signals.update(
            slip_reference=speeds,
            slip_reference_rate=rates,
            status=request.status,
            **command.signals,
            **request.parts,
        )
        return reply

    def advance(self, reply: PlantReply) -> None:
        """Integrate the driveline over the period that `reply` answered."""
        self.plant.advance(reply)
