# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The state before a shift: the car drives in the off-going gear, whose clutch is locked."""

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.initial_state import InitialSide, InitialState
from ddct_plant.shift.gear_pair import GearPair


def driving_start(
    gears: GearPair,
    wheel_speed: float,
    torques: tuple[float, float, float],
    free_shaft_speed: float | None = None,
) -> InitialState:
    """
    Return the steady drive in the off-going gear at a wheel speed in rad/s, without requests.

    `torques` are C_m, C_load of air and slope, and the friction at the wheels, in N m. The
    on-coming clutch is open; without `free_shaft_speed` in rad/s its gear is engaged too. The car
    accelerates as a rigid one, and the twist is that of this acceleration. With J and c of the
    shafts at the off-going one (J_m + J + J_v/tau^2) dw/dt = C_m - (c_m + c) w - C_load/tau, so
    that C_1 = C_m - c_m w - J_m dw/dt and k_sa theta_sr = C_load + J_v dw/dt / tau. Raise
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
    on_coming = InitialSide(on_coming_speed, open=True)
    off_going = InitialSide(speed, torque=delivered - p.engine_inertia * acceleration)
    return InitialState(
        engine_speed=speed,
        wheel_speed=wheel_speed,
        twist=(resisting + p.vehicle_inertia * wheel_acceleration) / p.halfshaft_stiffness,
        engine_torque=engine_torque,
        load_torque=load_torque,
        sides=(on_coming, off_going),
        wheel_torque=wheel_torque,
    )
