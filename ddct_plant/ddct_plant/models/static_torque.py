# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The clutch torque that keeps the slip speed constant, from the plant's own equations."""

from dataclasses import dataclass

from ddct_plant.models.parameters import DrivelineParameters

EQUILIBRIA = ('thesis', 'full')
"""Definitions of equilibrium for C_fOL and the start of a run; see `StaticTorque`."""


def constant_slip_torque(
    parameters: DrivelineParameters, engine_torque: float, load_torque: float
) -> float:
    """
    Return C_fOL in N m, the torque at which w_m and w_p accelerate alike.

    With a rigid driveline and no damping, J_m dw/dt = C_m - C_f and
    (J_p + J_v/tau^2) dw/dt = C_f - C_load/tau, so
    C_fOL = [C_m (J_p + J_v/tau^2) + J_m C_load/tau] / (J_m + J_p + J_v/tau^2).
    The thesis derives its static controller from the plant's differential equations (Section
    1.4.5.1) and prints no formula.
    """
    engine_side, vehicle_side = parameters.engine_inertia, parameters.vehicle_side_inertia
    resisting = parameters.gear.shaft_torque(engine_side * load_torque)
    return (engine_torque * vehicle_side + resisting) / (engine_side + vehicle_side)


@dataclass(frozen=True)
class StaticTorque:
    """
    Open-loop torque C_fOL of a scenario.

    With the equilibrium `thesis` it is `constant_slip_torque` of C_m and C_load. With `full` c_m
    and c_prim count too: the engine keeps C_m - c_m w_m, and C_load/tau + c_prim w_p resists at
    the primary shaft. Then constant torques keep the slip constant, except for the lag of the
    actuator.
    """

    driveline: DrivelineParameters
    """Parameters of the driveline."""
    equilibrium: str
    """Definition of equilibrium: one of EQUILIBRIA."""

    def torque(
        self, engine_torque: float, load_torque: float, engine_speed: float, shaft_speed: float
    ) -> float:
        """Return C_fOL in N m for C_m and C_load in N m, w_m and w_p in rad/s."""
        p = self.driveline
        if self.equilibrium == 'full':
            # Not in place: the arrays of a batch of runs must not change.
            engine_torque = engine_torque - p.engine_damping * engine_speed
            load_torque = load_torque + p.gear.wheel_torque(p.shaft_damping) * shaft_speed
        return constant_slip_torque(p, engine_torque, load_torque)

    def twist(self, clutch_torque: float, load_torque: float, shaft_speed: float) -> float:
        """
        Return theta_sr(0) in rad for transmitted C_f and C_load in N m and w_p in rad/s.

        It balances C_load in `thesis`. In `full` it also accelerates the vehicle with the shaft,
        C_load + J_v dw_r/dt, where (J_p + J_v/tau^2) tau dw_r/dt = C_f - c_prim w_p - C_load/tau.
        """
        p = self.driveline
        if self.equilibrium == 'thesis':
            return load_torque / p.halfshaft_stiffness
        resisting = p.gear.shaft_torque(load_torque)
        torque = clutch_torque - p.shaft_damping * shaft_speed - resisting
        wheel_acceleration = torque / p.gear.across(p.vehicle_side_inertia)
        return (load_torque + p.vehicle_inertia * wheel_acceleration) / p.halfshaft_stiffness
