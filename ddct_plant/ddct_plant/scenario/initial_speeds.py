# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The speeds of both clutch plates at the start of a run: as given, and what follows from them."""

from dataclasses import dataclass

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import ASSUMED, OptionGroup, option
from ddct_plant.models.driveline import LOCKED, OPEN, PHASES, SLIPPING
from ddct_plant.models.gearbox import EngagedGear

_DIGITS = 6
"""Significant digits of a speed that follows from another one, as files give them."""
_SHAFT_RAD_S = 160.0
_MOST_RAD_S = 1000.0


@dataclass(frozen=True)
class InitialSpeeds:
    """Speeds of the two clutch plates at t = 0; the wheel turns with the primary shaft."""

    engine_speed_rad_s: float
    """w_m(0) in rad/s; in a shift that of the off-going shaft."""
    shaft_speed_rad_s: float
    """w_p(0) in rad/s; in a shift that of the on-coming gear's shaft at the speed of the car."""
    clutch_phase: str | None
    """Phase of the clutch; None where it follows from the speeds."""

    def require_phase(self) -> None:
        """Raise ParameterError for a phase that does not fit the speeds."""
        slip = self.engine_speed_rad_s - self.shaft_speed_rad_s
        if self.clutch_phase == LOCKED and slip:
            raise ParameterError(
                f"initial.clutch_phase is 'locked', but the slip speed is {slip:g} rad/s: give "
                f'no initial.engine_speed_rad_s, or that of the shaft, {self.shaft_speed_rad_s:g}',
                key='initial.clutch_phase',
            )
        if self.clutch_phase == SLIPPING and not slip:
            raise ParameterError(
                "initial.clutch_phase is 'slipping', but both plates have one speed: give another "
                'initial.engine_speed_rad_s',
                key='initial.clutch_phase',
            )


@dataclass(frozen=True)
class InitialSection(OptionGroup, prefix='initial.'):
    """Section `initial` of a scenario: a speed that follows from another one may be left out."""

    speed_km_h: float | None = option(
        None,
        'speed of the car, from which that of the shaft follows by wheel radius and gear, rounded '
        'to six significant digits',
        'km/h',
        at_least=0.0,
        at_most=1000.0,
    )
    engine_speed_rad_s: float | None = option(
        None,
        'w_m(0)',
        'rad/s',
        source=ASSUMED,
        otherwise='that of the shaft; in a shift of the off-going one',
        at_least=0.0,
        at_most=_MOST_RAD_S,
    )
    shaft_speed_rad_s: float | None = option(
        None,
        'w_p(0); 160 rad/s is about 20 km/h in second gear',
        'rad/s',
        source=ASSUMED,
        otherwise=f'that of `speed_km_h`; without it {_SHAFT_RAD_S:g}',
        at_least=0.0,
        at_most=_MOST_RAD_S,
    )
    clutch_phase: str | None = option(
        None,
        'phase of the clutch at t = 0, which must fit the speeds; `open`: its request was zero '
        'before',
        otherwise='follows from the speeds',
        kind=str,
        choices=PHASES,
    )

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        super().__post_init__()
        if self.speed_km_h is not None and self.shaft_speed_rad_s is not None:
            raise ParameterError(
                f'initial.speed_km_h is {self.speed_km_h:g} and initial.shaft_speed_rad_s is '
                f'{self.shaft_speed_rad_s:g}: give one, from which the other follows, and null in '
                'place of the other, such as initial.speed_km_h=null',
                key='initial.speed_km_h',
            )

    def speeds(
        self, gear: EngagedGear, off_going: EngagedGear | None, wheel_radius_m: float
    ) -> InitialSpeeds:
        """
        Return the complete speeds, in a gear and with this wheel radius in m.

        `off_going` is the gear before a shift, in which the engine turns. Raise ParameterError
        where the engine speed of an open clutch is missing.
        """
        shaft = _SHAFT_RAD_S if self.shaft_speed_rad_s is None else self.shaft_speed_rad_s
        wheel = gear.wheel_speed(shaft)
        if self.speed_km_h is not None:
            wheel = self.speed_km_h / 3.6 / wheel_radius_m
            shaft = _rounded(gear.shaft_speed(wheel))
        engine = self.engine_speed_rad_s
        if engine is None:
            engine = shaft
            if off_going is not None:
                engine = _rounded(off_going.shaft_speed(wheel))
            elif self.clutch_phase == OPEN:
                raise ParameterError(
                    "initial.clutch_phase is 'open': give initial.engine_speed_rad_s, which does "
                    'not follow from the speed of the shaft then',
                    key='initial.clutch_phase',
                )
        return InitialSpeeds(engine, shaft, self.clutch_phase)


def _rounded(speed: float) -> float:
    return float(f'{speed:.{_DIGITS}g}')
