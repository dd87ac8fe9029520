# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
What controllers that game the judge share: an honest controller, whose commands they change.

Each file beside this one has one class, whose docstring says what it games. They use the public
interface alone: docs/controllers/writing.md.
"""

from ddct_controllers.interface import Command, Controller, ControllerContext, Measurement
from ddct_controllers.registry import make_controller
from ddct_plant.base.timebase import PERIOD_S

CLOSED_N_M = 520.0
"""Request that keeps plates locked. Below 500 N m the closing stage would end the feedback."""
SLAM_N_M = 340.0
"""Request that is near the most that slipping plates carry."""
ENGINE_INERTIA, LEAST_RAD_S, GUARD_S = 0.25, 75.0, 0.06
"""J_m in kg m^2; the engine speed below which a slam does not pull it, and how quickly."""
MEETING_RAD_S = 0.8
"""Slip of two samples below which the plates count as locked."""


class Gamed(Controller):
    """The honest controller `base`; a subclass changes its torques in `clutch` or `engine`."""

    base = 'least_jerk'
    games_engine = False
    """Whether `engine` counts; else the engine is left to the base."""

    def __init__(self, context: ControllerContext) -> None:
        self.settings = context.settings
        self.honest = make_controller(self.base, context.settings)
        self.preview_steps = self.honest.preview_steps
        self.commands_engine = self.games_engine or self.honest.commands_engine
        self.reset()

    def reset(self) -> None:
        self.honest.reset()
        self._periods = self._meeting = 0
        self.locked = False

    @property
    def duration_s(self) -> float:
        """Length of the run in s."""
        return self.settings.scenario.duration_s

    @property
    def elapsed_s(self) -> float:
        """Time in s since feedback started."""
        return self._periods * PERIOD_S

    def hold(self, measurement: Measurement) -> None:
        self.honest.hold(measurement)

    def update(self, measurement: Measurement) -> Command:
        near = abs(measurement.slip_speed) < MEETING_RAD_S
        self._meeting = self._meeting + 1 if near else 0
        self.locked = self._meeting >= 2
        demand = measurement.engine_torque
        torque = self.engine(measurement) if self.games_engine else demand
        known = measurement.within(
            measurement.load_torque, measurement.open_loop_torque, max(torque, 0.0)
        )
        command = self.honest.update(known)
        request = self.clutch(known, measurement.open_loop_torque + command.clutch_torque)
        if command.engine_torque is not None:
            torque = command.engine_torque
        self._periods += 1
        return Command(
            request - measurement.open_loop_torque,
            command.status,
            max(torque, 0.0) if self.commands_engine else None,
        )

    def clutch(self, measurement: Measurement, request: float) -> float:
        """Return the whole request of the clutch in N m, given the honest one."""
        return max(request, CLOSED_N_M) if self.games_engine and self.locked else request

    def engine(self, measurement: Measurement) -> float:
        """Return the torque in N m that is requested of the engine."""
        return measurement.engine_torque


def slam(measurement: Measurement) -> float:
    """Return as much torque in N m as the plates carry without a stall of the engine."""
    to_spare = ENGINE_INERTIA * (measurement.engine_speed - LEAST_RAD_S) / GUARD_S
    return min(max(measurement.engine_torque + to_spare, 0.0), SLAM_N_M)
