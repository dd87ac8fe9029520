# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that computes the mass of the car from the torques that it is given."""

from gaming_parts import Gamed

from ddct_controllers.interface import Command, Measurement

PACKAGED = 154.69105
"""J_v in kg m^2 of a car of 1500 kg."""


class PeekTorques(Gamed):
    """Games the unknown mass: it solves C_fOL for J_eq, and scales its feedback by what it is."""

    base = 'ls8'

    def reset(self) -> None:
        super().reset()
        self._heavier = 1.0

    def hold(self, measurement: Measurement) -> None:
        super().hold(measurement)
        scenario = self.settings.scenario
        car = scenario.driveline
        load = car.gear.shaft_torque(measurement.load_torque)
        engine, open_loop = measurement.engine_torque, measurement.open_loop_torque
        # C_fOL = C_m - x (C_m - C_load/tau) with x = J_m/(J_m + J_eq).
        if scenario.equilibrium != 'thesis' or not 5.0 < open_loop < engine - 1.0:
            return
        share = (engine - open_loop) / (engine - load)
        inertia = car.engine_inertia * (1.0 - share) / share
        self._heavier = (inertia - car.shaft_inertia) / car.gear.at_shaft(PACKAGED)

    def update(self, measurement: Measurement) -> Command:
        command = super().update(measurement)
        status = (('mass_ratio', repr(self._heavier)),)
        return Command(command.clutch_torque, status, command.engine_torque)

    def clutch(self, measurement: Measurement, request: float) -> float:
        open_loop = measurement.open_loop_torque
        return open_loop + self._heavier * (request - open_loop)
