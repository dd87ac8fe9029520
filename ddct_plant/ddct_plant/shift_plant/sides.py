# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Driveline of a shift and its signals; actuator and clutch of a run by their role."""

from ddct_plant.base.timebase import steps_in
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.clutch import FrictionClutch
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.scenario.initial_state import initial_request
from ddct_plant.scenario.plant import stick_slip_clutch
from ddct_plant.scenario.rules.shift import gears_of, shift_of
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.driveline import OffGoingOutputs, ShiftDriveline, ShiftOutputs
from ddct_plant.shift.roles import OFF_GOING, ON_COMING
from ddct_plant.shift_plant.start import locked_request, shift_start
from ddct_plant.signals.signal import SignalValue

_OF_TICK = (
    *DrivelineOutputs._fields,
    *(f'{OFF_GOING}_{name}' for name in OffGoingOutputs._fields),
    'tie_up_work',
)
"""Names of the signals of a tick, in the order of the outputs."""
OPEN_BELOW = 0.01
"""Torque in N m of the actuator up to which a clutch of a shift is open."""


def shift_driveline(settings: RunSettings) -> ShiftDriveline:
    """Return the driveline of a shift in the drive before it; raise ParameterError without one."""
    scenario, shift = settings.scenario, shift_of(settings.scenario)
    disengagement_s = shift.disengagement_s
    return ShiftDriveline(
        gears_of(scenario),
        scenario.vehicle,
        shift_start(settings),
        steps_in('shift.preselection_s', shift.preselection_s),
        None if disengagement_s is None else steps_in('shift.disengagement_s', disengagement_s),
    )


def shift_signals(outputs: ShiftOutputs) -> dict[str, SignalValue]:
    """Return the signals of a tick by name; those of the off-going side have a prefix."""
    values = *outputs.driveline, *outputs.off_going, outputs.tie_up_work
    return dict(zip(_OF_TICK, values, strict=True))


def first_request(settings: RunSettings, role: str) -> float:
    """
    Return the request before t_0 in N m of the clutch with a role.

    That of the off-going clutch keeps it locked, in the car that a controller knows.
    """
    if role == ON_COMING:
        return initial_request(settings)
    known = settings.known
    return locked_request(known.scenario, shift_start(known).off_going_torque)


def side_actuator(settings: RunSettings, role: str) -> Actuator:
    """Return the actuator of a clutch, in its steady state for the request before t_0."""
    return Actuator(first_request(settings, role), settings.scenario.actuator)


def side_clutch(settings: RunSettings, role: str) -> FrictionClutch:
    """Return the stick-slip clutch of a role, with its wear, at its initial temperatures."""
    if not settings.shift:
        return stick_slip_clutch(settings)
    scenario = settings.scenario
    wear_gain = settings.wear_gain if role == ON_COMING else settings.off_going_wear_gain
    return FrictionClutch(scenario.friction, wear_gain, scenario.heat, OPEN_BELOW)
