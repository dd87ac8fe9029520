# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The slip reference of a run, from its scenario and architecture."""

from dataclasses import replace

from ddct_plant.base.clutch_kinds import LINEAR, STICK_SLIP
from ddct_plant.base.timebase import PERIOD_S, steps_in, time_of_step
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.plant import Plant
from ddct_plant.scenario.control import ENGINE_SPEED_TARGET, PROFILE
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_reference.descent import CrfRamp, Descent, ProfileDescent, TimedDescent
from ddct_reference.engine_speed_target import EngineSpeedTarget
from ddct_reference.slip_reference import NEVER, DescendingReference, SlipReference


def make_reference(settings: KnownSettings, preview_steps: int = 0) -> SlipReference:
    """
    Build the reference of a run from its known settings, with a preview of so many periods.

    `detailed` follows the slip speed until control starts, and starts from the one measured then.
    In a shift control starts with the first period whose share of C_fOL is 1.
    The other architectures have a stored function of time, that of the nominal detailed run.
    """
    scenario = settings.scenario
    start_step = NEVER if settings.shift else scenario.control_start_step
    if settings.reference_shape == ENGINE_SPEED_TARGET:
        return EngineSpeedTarget(
            scenario.engine_speed_reference,
            scenario.reference.slope_rad_s2,
            start_step,
            preview_steps,
        )
    stored = [] if settings.detailed else nominal_slip(scenario)
    return DescendingReference(make_descent(settings), start_step, preview_steps, stored)


def make_descent(settings: KnownSettings) -> Descent:
    """Return the descent of a run's reference, which is not `engine_speed_target`."""
    reference = settings.scenario.reference
    if settings.reference_shape == 'ramp':
        return CrfRamp(reference.slope_rad_s2)
    if settings.reference_shape == PROFILE:
        scenario = settings.scenario
        return ProfileDescent(scenario.slip_reference, scenario.control_start_s)
    end_step = steps_in('reference.reference_end_s', reference.reference_end_s)
    duration_s = (end_step - settings.scenario.control_start_step) * PERIOD_S
    return TimedDescent(duration_s, settings.reference_shape)


def nominal_settings(scenario: Scenario) -> RunSettings:
    """
    Return the settings of the nominal detailed run: the known car with a clutch without wear.

    The clutch is the linear one, or the one that sticks where the linear one cannot run the
    scenario.
    """
    clutch = STICK_SLIP if scenario.of_stick_slip else LINEAR
    return RunSettings(KnownSettings(replace(scenario, clutch=clutch)))


def nominal_slip(scenario: Scenario) -> list[float]:
    """
    Return w_d in rad/s at steps 0, 1, ..., up to and with the first controlled one.

    It is that of the nominal detailed run. Until control starts feedback is off and only the
    static controller C_fOL acts. So no controller enters: the values are those of any controller's
    run, to the last bit.
    """
    plant = Plant(nominal_settings(scenario))
    static = StaticTorque(scenario.driveline, scenario.equilibrium)
    load = RoadLoad(scenario.load, scenario.vehicle, scenario.slope)
    slips = []
    for step in range(scenario.control_start_step + 1):
        tick = plant.tick(step)
        observation, true = plant.observe(tick), tick.true
        slips.append(true.slip_speed)
        load_torque = load.torque(true.vehicle_speed, time_of_step(step))
        assert observation.delivered is not None
        speeds = true.engine_speed, true.shaft_speed
        request = static.torque(observation.delivered, load_torque, *speeds)
        plant.advance(plant.reply(observation, request))
    return slips
