"""Slip speed before control starts of the nominal detailed run: a clutch without wear."""

from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.clutch import LinearClutch
from ddct_plant.models.driveline import Driveline
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.initial import initial_state
from ddct_plant.scenario.plant import make_engine
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings


def nominal_slip(scenario: Scenario) -> list[float]:
    """
    Return w_d in rad/s at steps 0, 1, ..., up to and with the first controlled one.

    Until then feedback is off and only the static controller C_fOL acts, so no controller enters:
    the values are those of any controller's detailed run at wear gain 1 with the actuator as
    printed, to the last bit.
    """
    settings = RunSettings(scenario, architecture='detailed')
    initial = initial_state(settings)
    driveline = Driveline(scenario.driveline, scenario.vehicle, initial)
    engine = make_engine(settings)
    load = RoadLoad(scenario.load, scenario.vehicle, scenario.slope)
    static = StaticTorque(scenario.driveline, scenario.equilibrium)
    actuator, clutch = Actuator(initial.torque_request), LinearClutch()
    now = driveline.outputs()
    slips = [now.slip_speed]
    for step in range(scenario.control_start_step):
        engine_speed, shaft_speed = now.joint_speed[:2]
        engine_torque = engine.torque(step, speed=engine_speed)
        load_torque = load.torque(now.vehicle_speed, time_of_step(step))
        request = static.torque(engine_torque, load_torque, engine_speed, shaft_speed)
        transmitted = clutch.transmit(actuator.update(request))
        driveline.step(engine_torque, load_torque, transmitted)
        now = driveline.outputs()
        slips.append(now.slip_speed)
    return slips
