# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rules for a scenario with a gear shift: gears, events of the gearbox and speeds that agree."""

import math

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.driveline import OPEN
from ddct_plant.models.gearbox import AGREE
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.shift.gear_pair import GearPair
from ddct_plant.shift.parameters import ShiftParameters


def shift_of(scenario: Scenario) -> ShiftParameters:
    """Return the keys of the shift; raise ParameterError for a scenario without one."""
    if scenario.shift is None:
        raise ParameterError(
            f'scenario {scenario.name} has no section shift: give one, with shift.off_going_gear',
            key='shift',
        )
    return scenario.shift


def gears_of(scenario: Scenario) -> GearPair:
    """Return both gears of the shift; raise ParameterError for a scenario without one."""
    return scenario.gears_of(shift_of(scenario))


def require_shift(scenario: Scenario) -> None:
    """Raise ParameterError that names the first value with which the scenario cannot shift."""
    shift = shift_of(scenario)
    _require_gears(scenario.gear, shift)
    _require_times(scenario.control_start_s, shift)
    _require_start(scenario, shift)


def _require_gears(on_coming: int, shift: ShiftParameters) -> None:
    """Raise ParameterError unless it is an upshift from one clutch to the other."""
    off_going = shift.off_going_gear
    if on_coming < off_going or (on_coming - off_going) % 2 == 0:
        raise ParameterError(
            f'shift.off_going_gear is {off_going}, and gear, the on-coming one, is '
            f'{on_coming}: give a higher gear as gear, one of them even and the other '
            'odd, as each clutch has the even or the odd gears, and only upshifts are simulated',
            key='shift.off_going_gear',
        )


def _require_times(start_s: float, shift: ShiftParameters) -> None:
    if shift.preselection_s > start_s:
        raise ParameterError(
            f'shift.preselection_s is {shift.preselection_s:g} s: it must not be after '
            f'control_start_s, {start_s:g} s, when the shift starts',
            key='shift.preselection_s',
        )
    handed_over_s = start_s + shift.handover_s
    if shift.disengagement_s is not None and shift.disengagement_s <= handed_over_s:
        raise ParameterError(
            f'shift.disengagement_s is {shift.disengagement_s:g} s: it must be after '
            f'{handed_over_s:g} s, control_start_s and shift.handover_s, until when the off-going '
            'clutch carries torque',
            key='shift.disengagement_s',
        )


def _require_start(scenario: Scenario, shift: ShiftParameters) -> None:
    initial, gears = scenario.initial, gears_of(scenario)
    if initial.clutch_phase not in (None, OPEN):
        raise ParameterError(
            f'initial.clutch_phase is {initial.clutch_phase!r}: before a shift the on-coming '
            f'clutch is {OPEN!r}',
            key='initial.clutch_phase',
        )
    given, speed = initial.engine_speed_rad_s, gears.ratio * initial.shaft_speed_rad_s
    if not math.isclose(given, speed, rel_tol=AGREE):
        raise ParameterError(
            f'initial.engine_speed_rad_s is {given:g}: before a shift the off-going clutch is '
            'locked, so leave it out, or give the speed of its shaft in gear '
            f'{shift.off_going_gear}, {speed:.6g} rad/s',
            key='initial.engine_speed_rad_s',
        )
