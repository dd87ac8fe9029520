"""The state a run starts from."""

from ddct_plant.models.clutch import LinearClutch
from ddct_plant.models.driveline import InitialState
from ddct_plant.models.engine import Engine
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.settings import RunSettings


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
