# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The settings of a run with a gear shift, checked together."""

import math
from dataclasses import dataclass

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.clutch import STICK_SLIP, WEAR_GAIN
from ddct_plant.models.driveline import OPEN
from ddct_plant.models.gearbox import AGREE, C635
from ddct_plant.scenario.control import ClosingParameters
from ddct_plant.scenario.plant import holding_torque, make_engine, make_load
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.gear_pair import GearPair
from ddct_plant.shift.parameters import ShiftParameters
from ddct_plant.shift.start import ShiftStart, driving_start


@dataclass(frozen=True)
class ShiftSettings:
    """Settings of a run, its shift, and the wear of the off-going clutch."""

    run: RunSettings
    """Settings that every run has; its `wear_gain` is that of the on-coming clutch."""
    shift: ShiftParameters
    """Off-going gear, and the events of the gearbox."""
    off_going_wear_gain: float = WEAR_GAIN.default
    """K_usura of the off-going clutch."""

    def __post_init__(self) -> None:
        """Check that scenario and shift fit; raise ParameterError that names a bad value."""
        WEAR_GAIN.checked('off_going_wear_gain', self.off_going_wear_gain)
        if not self.run.stick_slip:
            raise ParameterError(
                f'the clutch {self.run.clutch} cannot lock, so it cannot shift: choose the clutch '
                f'{STICK_SLIP}',
                key='clutch',
            )
        self._require_gears()
        self._require_times()
        self._require_start()

    def _require_gears(self) -> None:
        on_coming, off_going = self.run.scenario.gear, self.shift.off_going_gear
        if on_coming is None or on_coming == off_going:
            raise ParameterError(
                f'shift.off_going_gear is {off_going}, and gear, the on-coming one, is '
                f'{on_coming or "none"}: give two gears of the C635',
                key='shift.off_going_gear',
            )

    def _require_times(self) -> None:
        start_s, shift = self.run.scenario.control_start_s, self.shift
        if shift.preselection_s > start_s:
            raise ParameterError(
                f'shift.preselection_s is {shift.preselection_s:g} s: it must not be after '
                f'control_start_s, {start_s:g} s, when the shift starts',
                key='shift.preselection_s',
            )
        if shift.disengagement_s is not None and shift.disengagement_s <= start_s:
            raise ParameterError(
                f'shift.disengagement_s is {shift.disengagement_s:g} s: it must be after '
                f'control_start_s, {start_s:g} s, when the shift starts',
                key='shift.disengagement_s',
            )

    def _require_start(self) -> None:
        initial = self.run.scenario.initial
        if initial.clutch_phase not in (None, OPEN):
            raise ParameterError(
                f'initial.clutch_phase is {initial.clutch_phase!r}: before a shift the on-coming '
                f'clutch is {OPEN!r}',
                key='initial.clutch_phase',
            )
        given, speed = initial.engine_speed_rad_s, self._off_going_speed
        if not math.isclose(given, speed, rel_tol=AGREE):
            raise ParameterError(
                f'initial.engine_speed_rad_s is {given:g}: before a shift the off-going clutch is '
                f'locked, so give the speed of its shaft in gear {self.shift.off_going_gear}, '
                f'{speed:.6g} rad/s',
                key='initial.engine_speed_rad_s',
            )

    @property
    def gears(self) -> GearPair:
        """Both gears, with the driveline of the scenario."""
        return GearPair(self.run.scenario.driveline, C635.gear(self.shift.off_going_gear))

    @property
    def _off_going_speed(self) -> float:
        return self.gears.ratio * self.run.scenario.initial.shaft_speed_rad_s

    def start(self) -> ShiftStart:
        """
        Return the state at t_0: the car drives in the off-going gear.

        `initial.shaft_speed_rad_s` is that of the on-coming shaft in its gear, so it gives the
        speed of the car also if the gear is engaged later.
        """
        scenario, shift = self.run.scenario, self.shift
        wheel_speed = scenario.driveline.gear.wheel_speed(scenario.initial.shaft_speed_rad_s)
        vehicle_speed = wheel_speed * scenario.vehicle.wheel_radius_m
        torques = (
            make_engine(self.run).torque(0, speed=self._off_going_speed),
            make_load(self.run).torque(vehicle_speed),
            holding_torque(self.run).capacity(0.0),
        )
        free = shift.free_shaft_rad_s if shift.preselection_s else None
        return driving_start(self.gears, wheel_speed, torques, free)

    def locked_request(self, carried: float) -> float:
        """Return the request in N m that keeps a clutch locked that carries a torque in N m."""
        closing = self.run.scenario.closing or ClosingParameters()
        carried = abs(carried)
        return max(min(closing.margin * carried + closing.reserve_n_m, closing.most_n_m), carried)
