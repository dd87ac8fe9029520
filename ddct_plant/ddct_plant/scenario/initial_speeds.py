# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The speeds of both clutch plates at the start of a run, as a scenario gives them."""

from dataclasses import dataclass

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import ASSUMED, OptionGroup, option
from ddct_plant.models.driveline import LOCKED, PHASES, SLIPPING


@dataclass(frozen=True)
class InitialSpeeds(OptionGroup, prefix='initial.'):
    """Speeds of the two clutch plates at t = 0; the wheel turns with the primary shaft."""

    engine_speed_rad_s: float = option(
        160.0, 'w_m(0)', 'rad/s', source=ASSUMED, at_least=0.0, at_most=1000.0
    )
    shaft_speed_rad_s: float = option(
        160.0,
        'w_p(0); 160 rad/s is about 20 km/h in second gear',
        'rad/s',
        source=ASSUMED,
        at_least=0.0,
        at_most=1000.0,
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
        slip = self.engine_speed_rad_s - self.shaft_speed_rad_s
        if self.clutch_phase == LOCKED and slip:
            raise ParameterError(
                f"initial.clutch_phase is 'locked', but the slip speed is {slip:g} rad/s: make "
                'initial.engine_speed_rad_s and initial.shaft_speed_rad_s equal',
                key='initial.clutch_phase',
            )
        if self.clutch_phase == SLIPPING and not slip:
            raise ParameterError(
                "initial.clutch_phase is 'slipping', but both plates have one speed: make "
                'initial.engine_speed_rad_s and initial.shaft_speed_rad_s differ',
                key='initial.clutch_phase',
            )
