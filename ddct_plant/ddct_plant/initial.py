"""The state a run starts from."""

from dataclasses import dataclass

from ddct_plant.clutch import LinearClutch
from ddct_plant.engine import Engine
from ddct_plant.load import RoadLoad
from ddct_plant.run_settings import RunSettings
from ddct_plant.static_torque import StaticTorque


@dataclass(frozen=True)
class InitialState:
    """
    Speeds, driveshaft twist and the torques that hold before t_0.

    The wheel turns with the primary shaft (w_sr = 0); theta_sr balances the load, and with the
    equilibrium `full` what accelerates the vehicle too. The actuator is at rest on
    `torque_request`, which the clutch transmits times the wear gain.
    """

    engine_speed: float
    """w_m(0) in rad/s."""
    shaft_speed: float
    """w_p(0) in rad/s."""
    wheel_speed: float
    """w_r(0) in rad/s."""
    twist: float
    """theta_sr(0) in rad."""
    engine_torque: float
    """C_m(0) in N m."""
    load_torque: float
    """C_load(0) in N m."""
    torque_request: float
    """What the clutch is asked before t_0, in N m: C_fOL(0) in `detailed`, 0 elsewhere."""
    clutch_torque: float
    """What it transmits then, in N m."""


def initial_state(settings: RunSettings) -> InitialState:
    """Return the state at t_0 of a run with these settings."""
    scenario = settings.scenario
    driveline = scenario.driveline
    wheel_speed = scenario.initial.shaft_speed_rad_s / driveline.total_ratio
    load_torque = RoadLoad(scenario.load, scenario.vehicle).torque(
        wheel_speed * scenario.vehicle.wheel_radius_m
    )
    engine_torque = Engine(scenario.engine).torque(0)
    static = StaticTorque(driveline, scenario.equilibrium)
    shaft_speed = scenario.initial.shaft_speed_rad_s
    static_torque = static.torque(
        engine_torque, load_torque, scenario.initial.engine_speed_rad_s, shaft_speed
    )
    torque_request = max(static_torque, 0.0) if settings.detailed else 0.0
    clutch_torque = LinearClutch(settings.wear_gain).transmit([torque_request])[0]
    return InitialState(
        engine_speed=scenario.initial.engine_speed_rad_s,
        shaft_speed=shaft_speed,
        wheel_speed=wheel_speed,
        twist=static.twist(clutch_torque, load_torque, shaft_speed),
        engine_torque=engine_torque,
        load_torque=load_torque,
        torque_request=torque_request,
        clutch_torque=clutch_torque,
    )
