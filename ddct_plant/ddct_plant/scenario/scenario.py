# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A scenario: everything about a run except the controller and the run settings."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from ddct_plant.base.clutch_kinds import CLUTCHES, LINEAR, STICK_SLIP
from ddct_plant.base.errors import ParameterError, require_name
from ddct_plant.base.options import ASSUMED, REQUIRED, OptionGroup, option, section
from ddct_plant.base.timebase import LONGEST_S, steps_in
from ddct_plant.models.actuator import ActuatorParameters
from ddct_plant.models.body import Body
from ddct_plant.models.clutch import FrictionParameters
from ddct_plant.models.clutch_heat import HeatParameters
from ddct_plant.models.engine import EngineAuthority, TorqueProfile
from ddct_plant.models.engine_limits import EngineLimits
from ddct_plant.models.gearbox import Gearbox
from ddct_plant.models.load import BrakeProfile, LoadParameters, SlopeProfile
from ddct_plant.models.parameters import DrivelineParameters, DrivelineSection, VehicleParameters
from ddct_plant.models.static_torque import EQUILIBRIA
from ddct_plant.scenario.control import (
    ClosingParameters,
    EngineSpeedReference,
    ReferenceParameters,
    SlipProfile,
)
from ddct_plant.scenario.initial_speeds import InitialSection, InitialSpeeds
from ddct_plant.sensors.parameters import SensorParameters
from ddct_plant.shift.gear_pair import GearPair
from ddct_plant.shift.parameters import ShiftParameters


@dataclass(frozen=True)
class Scenario(OptionGroup):
    """One driving situation and its score window; docs/use/cases.md lists every key."""

    name: str = option(
        REQUIRED,
        'name in scores: up to 64 letters A to Z, digits, dots, dashes and underscores, no '
        'dot or dash first',
        otherwise="the file's name",
        kind=str,
    )
    description: str = option(REQUIRED, 'free text', otherwise='empty', kind=str)
    duration_s: float = option(
        REQUIRED,
        'length of the run, a multiple of 10 ms',
        's',
        above=0.0,
        at_most=LONGEST_S,
        whole_periods=True,
    )
    control_start_s: float = option(
        REQUIRED,
        'when the reference starts towards zero, and in `detailed` also when feedback starts '
        '(thesis: 0.6); a multiple of 10 ms',
        's',
        at_least=0.0,
        at_most=LONGEST_S,
        whole_periods=True,
    )
    score_window_s: tuple[float, float] = option(
        REQUIRED,
        '`[first, last]` sample of the standard deviations, multiples of 10 ms',
        's',
        many=True,
        at_least=0.0,
        at_most=LONGEST_S,
        whole_periods=True,
    )
    engine: TorqueProfile = field(default=REQUIRED)
    engine_authority: EngineAuthority = EngineAuthority()
    engine_speed_reference: EngineSpeedReference = EngineSpeedReference()
    pedal_position: float = option(
        0.5,
        'x_p, the accelerator pedal (Section 1.3); `pedal_mpc` takes its engagement time from it',
        source=ASSUMED,
        at_least=0.0,
        at_most=1.0,
    )
    equilibrium: str = option(
        'thesis',
        '`full`: C_fOL counts the damping c_m and c_prim, and theta_sr at the start accelerates '
        'the vehicle with the shaft, so that constant torques hold the slip constant',
        choices=EQUILIBRIA,
    )
    given_initial: InitialSection = section(InitialSection(), key='initial')
    """Section `initial` of the file; models take `initial`, which is complete."""
    reference: ReferenceParameters = ReferenceParameters()
    slip_reference: SlipProfile = section(SlipProfile(), left_out=True)
    slope: SlopeProfile = section(SlopeProfile(), left_out=True)
    load: LoadParameters = LoadParameters()
    vehicle: VehicleParameters = VehicleParameters()
    given_driveline: DrivelineSection = section(DrivelineSection(), key='driveline')
    """Section `driveline` of the file; models take `driveline`, which is complete."""
    gearbox: Gearbox = section(Gearbox(), left_out=True)
    actuator: ActuatorParameters = section(ActuatorParameters(), left_out=True)
    clutch: str = option(
        LINEAR,
        'model of the clutch: `linear` transmits what the actuator gives, as in the thesis; with '
        '`stick_slip` the plates stick and slip, and friction and brake hold the wheels',
        choices=CLUTCHES,
        left_out=True,
    )
    friction: FrictionParameters = section(FrictionParameters(), left_out=True, stick_slip=True)
    heat: HeatParameters = section(HeatParameters(), left_out=True, stick_slip=True)
    brake: BrakeProfile = section(BrakeProfile(), left_out=True, stick_slip=True)
    engine_limits: EngineLimits | None = None
    closing: ClosingParameters | None = section(None, stick_slip=True)
    shift: ShiftParameters | None = section(None, stick_slip=True)
    sensors: SensorParameters | None = None
    controllers: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """Options by controller name; each controller checks its own."""
    gear: int = option(
        2,
        'engaged gear, one of `gearbox`; in a shift the on-coming one',
        source='`identify`: tau is that of second gear',
        at_least=1,
    )
    adjusted: tuple[str, ...] = option(
        (),
        'remarks that programs write: values that were moved to agree with given ones, and '
        'values that no car has',
        kind=str,
        many=True,
        left_out=True,
    )

    def __post_init__(self) -> None:
        """Check name, options and score window; raise ParameterError that names a bad one."""
        super().__post_init__()
        require_name('name', self.name)
        if len(self.score_window_s) != 2:
            raise ParameterError(
                'score_window_s: give two times, [first, last]', key='score_window_s'
            )
        first, last = self.score_window_s
        if last <= first:
            raise ParameterError(
                f'score_window_s ends at {last:g} s, before {first:g} s', key='score_window_s'
            )
        if last < self.control_start_s:
            raise ParameterError(
                f'score_window_s ends at {last:g} s, before control_start_s, '
                f'{self.control_start_s:g} s, so nothing of the control is scored: give a later '
                'window',
                key='score_window_s',
            )
        if self.given_driveline.vehicle_inertia is not None:
            vehicle, inertia = self.vehicle, self.given_driveline.vehicle_inertia
            Body(vehicle.mass_kg, vehicle.wheel_radius_m, inertia).require_agreement()
        _ = self.demand  # refuses a share of an unknown engine
        self.gearbox.require_gear('gear', self.gear)
        if self.shift is not None:
            self.gearbox.require_gear('shift.off_going_gear', self.shift.off_going_gear)
        self.initial.require_phase()
        self._require_clutch()
        if self.slope.given and self.load.slope_rad:
            raise ParameterError(
                f'slope has points, and load.slope_rad is {self.load.slope_rad:g} rad: give one',
                key='slope',
            )

    def _require_clutch(self) -> None:
        """Refuse keys that the linear clutch would ignore."""
        given = self.of_stick_slip
        if given and self.clutch != STICK_SLIP:
            raise ParameterError(
                f'the clutch {self.clutch} would ignore {", ".join(given)}: give the car clutch: '
                f'{STICK_SLIP}, or leave that out',
                key=given[0],
            )

    @cached_property
    def demand(self) -> TorqueProfile:
        """The driver's torque demand in N m over scenario time."""
        return self.engine.in_n_m(self.engine_limits)

    @cached_property
    def driveline(self) -> DrivelineParameters:
        """Driveline in the engaged gear, for models; raise ParameterError for a bad value."""
        return self.given_driveline.engaged(self.gearbox.gear(self.gear), self.vehicle.inertia)

    @cached_property
    def initial(self) -> InitialSpeeds:
        """Speeds of both plates at the start; raise ParameterError for some that contradict."""
        off_going = self.gearbox.gear(self.shift.off_going_gear) if self.shift else None
        return self.given_initial.speeds(
            self.driveline.gear, off_going, self.vehicle.wheel_radius_m
        )

    @cached_property
    def controlled_driveline(self) -> DrivelineParameters:
        """Driveline behind the controlled clutch; in a shift it turns the off-going shaft too."""
        if self.shift is None:
            return self.driveline
        return self.gears_of(self.shift).both_engaged

    def gears_of(self, shift: ShiftParameters) -> GearPair:
        """Return both gears of a shift of this car."""
        return GearPair(self.driveline, self.gearbox.gear(shift.off_going_gear))

    @property
    def steps(self) -> int:
        """Number N of 10 ms periods of the run."""
        return steps_in('duration_s', self.duration_s)

    def end_cause(self, engine_speed: float) -> str | None:
        """Return the cause of an early end with the engine at w_m in rad/s, None without one."""
        return self.engine_limits.end_cause(engine_speed) if self.engine_limits else None

    @property
    def of_stick_slip(self) -> tuple[str, ...]:
        """Given keys that only the stick-slip clutch uses."""
        sections = [
            each.name
            for each in dataclasses.fields(self)
            if each.metadata.get('stick_slip') and getattr(self, each.name) != each.default
        ]
        phase = ['initial.clutch_phase'] if self.initial.clutch_phase else []
        return (*phase, *sections)

    @property
    def control_start_step(self) -> int:
        """First step at which feedback and reference are on."""
        return steps_in('control_start_s', self.control_start_s)
