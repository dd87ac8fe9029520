# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The state before a shift: the car drives in the off-going gear, whose clutch is locked."""

from dataclasses import dataclass

from ddct_plant.base.errors import ParameterError
from ddct_plant.shift.gear_pair import GearPair


@dataclass(frozen=True)
class ShiftStart:
    """Speeds, twist and torques before t_0; the on-coming clutch is open."""

    engine_speed: float
    """Engine speed w_m(0) in rad/s."""
    on_coming_speed: float
    """Speed of the on-coming primary shaft in rad/s."""
    off_going_speed: float
    """Speed of the off-going primary shaft in rad/s."""
    wheel_speed: float
    """Wheel speed w_r(0) in rad/s."""
    twist: float
    """Twist of the driveshaft theta_sr(0) in rad."""
    engine_torque: float
    """Engine torque C_m(0) in N m."""
    load_torque: float
    """Load torque of air and slope in N m."""
    off_going_torque: float
    """Torque C_1 in N m that the off-going clutch transmits."""
    wheel_torque: float
    """Friction of rolling resistance and brake at the wheels in N m."""

    @property
    def values(self) -> list[float]:
        """Values of SHIFT_STATES, with angles that start at zero."""
        speeds = [self.engine_speed, self.on_coming_speed, self.wheel_speed]
        return [*speeds, self.twist, 0.0, 0.0, 0.0, self.off_going_speed, 0.0]


def driving_start(
    gears: GearPair,
    wheel_speed: float,
    torques: tuple[float, float, float],
    free_shaft_speed: float | None = None,
) -> ShiftStart:
    """
    Return the steady drive in the off-going gear at a wheel speed in rad/s.

    `torques` are C_m, C_load of air and slope, and the friction at the wheels, in N m. Without
    `free_shaft_speed` in rad/s the on-coming gear is engaged too. The car accelerates as a rigid
    one, and the twist is that of this acceleration. With J and c of the shafts at the off-going
    one (J_m + J + J_v/tau^2) dw/dt = C_m - (c_m + c) w - C_load/tau, so that
    C_1 = C_m - c_m w - J_m dw/dt and k_sa theta_sr = C_load + J_v dw/dt / tau. Raise
    ParameterError for a car that does not move forward.
    """
    if wheel_speed <= 0.0:
        raise ParameterError(
            f'initial.shaft_speed_rad_s gives a wheel speed of {wheel_speed:g} rad/s: a shift '
            'starts in a car that moves forward',
            key='initial.shaft_speed_rad_s',
        )
    engine_torque, load_torque, wheel_torque = torques
    p, gear = gears.in_off_going_gear, gears.off_going
    speed = gear.shaft_speed(wheel_speed)
    on_coming_speed = speed / gears.ratio if free_shaft_speed is None else free_shaft_speed
    share = 1.0 + gears.ratio**-2 if free_shaft_speed is None else 1.0
    resisting = load_torque + wheel_torque
    delivered = engine_torque - p.engine_damping * speed
    inertia = p.engine_inertia + share * p.shaft_inertia + gear.at_shaft(p.vehicle_inertia)
    net = delivered - share * p.shaft_damping * speed - gear.shaft_torque(resisting)
    acceleration = net / inertia
    wheel_acceleration = gear.wheel_speed(acceleration)
    return ShiftStart(
        engine_speed=speed,
        on_coming_speed=on_coming_speed,
        off_going_speed=speed,
        wheel_speed=wheel_speed,
        twist=(resisting + p.vehicle_inertia * wheel_acceleration) / p.halfshaft_stiffness,
        engine_torque=engine_torque,
        load_torque=load_torque,
        off_going_torque=delivered - p.engine_inertia * acceleration,
        wheel_torque=wheel_torque,
    )
