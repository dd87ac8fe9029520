# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A shift under a handover alone: the on-coming clutch is asked for C_fOL, without feedback."""

from dataclasses import replace
from typing import NamedTuple

from ddct_controllers.handover.interface import Handover, HandoverCommand, HandoverMeasurement
from ddct_controllers.handover.laws import make_handover
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.plant import Plant
from ddct_plant.scenario.settings import RunSettings


class Tick(NamedTuple):
    """Outputs of a step, and the command in it."""

    outputs: DrivelineOutputs
    command: HandoverCommand


def shift(
    settings: RunSettings,
    name: str,
    in_inertia_phase: float = 1.2,
    law: Handover | None = None,
) -> list[Tick]:
    """Run a shift whose on-coming clutch is asked for C_fOL, times a factor at the end."""
    plant = Plant(settings)
    law = law or make_handover(replace(settings.known, handover=name))
    static = StaticTorque(settings.scenario.controlled_driveline, 'full')
    found = []
    for step in range(130):
        tick = plant.tick(step)
        now = tick.true
        command = law.update(HandoverMeasurement.of_tick(tick))
        observation = plant.observe(tick, command.torque_cut)
        torque = static.torque(
            observation.engine_torque, now.joint_effort.wheel, now.engine_speed, now.shaft_speed
        )
        torque *= command.share if command.share < 1.0 else in_inertia_phase
        request = command.on_coming.request(torque)
        found.append(Tick(now, command))
        plant.advance(
            plant.reply(observation, request, off_going_request=command.off_going_request)
        )
    return found


def flare(ticks: list[Tick]) -> float:
    """Return the largest slip in rad/s by which the engine ran ahead of the off-going shaft."""
    return max(tick.outputs.off_going.slip_speed for tick in ticks)


def tie_up_work(ticks: list[Tick]) -> float:
    """Return the work in J that the off-going clutch took from its shaft."""
    sides = [tick.outputs.off_going for tick in ticks]
    return sum(max(-side.transmitted_torque, 0.0) * side.shaft_speed * PERIOD_S for side in sides)
