# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Keys of a shift: off-going gear, engagement of the gears, handover of the torque."""

from dataclasses import dataclass

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import ASSUMED, REQUIRED, OptionGroup, option
from ddct_plant.base.timebase import LONGEST_S


@dataclass(frozen=True)
class ShiftParameters(OptionGroup, prefix='shift.'):
    """
    Gears, events of the gearbox, and handover; the on-coming gear is the scenario's `gear`.

    Synchronisers are not modelled: at preselection the free shaft takes the speed of its gear at
    once, without a torque on the driveline.
    """

    off_going_gear: int = option(
        REQUIRED,
        'gear in which the car drives before the shift, one of `gearbox`',
        kind=int,
        at_least=1,
    )
    preselection_s: float = option(
        0.0,
        'when the on-coming gear is engaged, with its clutch open; 0: before the run; a multiple '
        'of 10 ms',
        's',
        source=ASSUMED,
        at_least=0.0,
        at_most=LONGEST_S,
        whole_periods=True,
    )
    free_shaft_rad_s: float = option(
        0.0,
        'speed of the on-coming primary shaft at t = 0 if its gear is engaged later',
        'rad/s',
        source=ASSUMED,
        at_least=0.0,
        at_most=1000.0,
    )
    disengagement_s: float | None = option(
        None,
        'when the off-going gear is disengaged, with its clutch open: a multiple of 10 ms, after '
        '`preselection_s`',
        's',
        otherwise='never',
        at_least=0.0,
        at_most=LONGEST_S,
        whole_periods=True,
    )
    handover_s: float = option(
        0.2,
        'how long the on-coming clutch takes over the torque: a multiple of 10 ms',
        's',
        source=ASSUMED,
        above=0.0,
        at_most=10.0,
        whole_periods=True,
    )
    handover_slip_rad_s: float = option(
        5.0,
        'slip speed at which the handover `slip` keeps the off-going clutch',
        'rad/s',
        source=ASSUMED,
        above=0.0,
        at_most=100.0,
    )
    torque_cut_n_m: float = option(
        0.0,
        "torque that the handover takes off the driver's demand in the inertia phase",
        'N m',
        source=ASSUMED,
        at_least=0.0,
        at_most=1000.0,
    )

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        super().__post_init__()
        if self.disengagement_s is not None and self.disengagement_s <= self.preselection_s:
            raise ParameterError(
                f'shift.disengagement_s is {self.disengagement_s:g} s: it must be after '
                f'shift.preselection_s, {self.preselection_s:g} s',
                key='shift.disengagement_s',
            )
