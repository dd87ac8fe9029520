# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The gearbox: ratios of its gears, final drives, and the values at either side of an engaged gear.

No other module uses a total ratio. Others have an `EngagedGear`, which returns the speed, the
torque or the inertia at its other side.
"""

from dataclasses import dataclass, replace
from typing import Any

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.base.options import OptionGroup, option

IDENTIFIED_RATIO = 9.3416024
"""Total ratio tau of the thesis's car, from `identify`: that of second gear."""
RATIOS_OF_CARS = (1.5, 60.0)
"""Least and largest total ratio of gearbox and final drive of a car or truck."""
AGREE = 1e-3
"""Largest relative difference of two values that count as the same gear or the same car."""
_SAME_GEAR = 0.01
"""Largest relative difference of a measured total ratio from the gear that it is taken for."""


@dataclass(frozen=True)
class EngagedGear:
    """
    The gear that connects a primary shaft with the wheels: w_p = tau w_r, rigid and without loss.

    Values may be numbers or arrays. With an array of ratios it is the gear of many runs.
    """

    total_ratio: float = IDENTIFIED_RATIO
    """Total ratio tau without unit: that of the gear times that of its final drive."""

    def __post_init__(self) -> None:
        """Check the ratio; raise ParameterError unless it is finite and above 0."""
        require_number('total_ratio', self.total_ratio, above=0.0)

    def __str__(self) -> str:
        """Return the total ratio as text."""
        return f'{self.total_ratio:g}'

    def shaft_speed(self, wheel_speed: Any) -> Any:
        """Return the speed of the primary shaft tau w_r in rad/s for w_r in rad/s."""
        return self.total_ratio * wheel_speed

    def wheel_speed(self, shaft_speed: Any) -> Any:
        """Return the speed at the wheels w_p/tau in rad/s for w_p in rad/s."""
        return shaft_speed / self.total_ratio

    def shaft_ratio(self, other: 'EngagedGear') -> float:
        """Return the speed of this gear's primary shaft over that of `other`, both engaged."""
        return self.total_ratio / other.total_ratio

    def wheel_torque(self, shaft_torque: Any) -> Any:
        """Return the torque at the wheels tau C in N m for C in N m at the primary shaft."""
        return self.total_ratio * shaft_torque

    def shaft_torque(self, wheel_torque: Any) -> Any:
        """Return the torque at the primary shaft C/tau in N m for C in N m at the wheels."""
        return wheel_torque / self.total_ratio

    def at_shaft(self, of_wheels: Any) -> Any:
        """Return J/tau^2, an inertia, damping or stiffness of the wheels at the primary shaft."""
        return of_wheels / self.total_ratio**2

    def across(self, inertia: Any) -> Any:
        """Return J tau in kg m^2: a torque of one side over it accelerates J on the other side."""
        return inertia * self.total_ratio


@dataclass(frozen=True)
class Gearbox(OptionGroup, prefix='gearbox.'):
    """
    Forward gears, each with the final drive of the output shaft that it sits on.

    A gear whose total ratio is measured has the measured one in place of the product of the
    published ratios. The defaults are those of the C635. Gears 1, 3, 6 and 2, 4, 5 sit on two
    output shafts. Only the final drive 4.118 is published: with 2.269 it gives the identified
    total ratio to 0.03 %. That the other shaft has the same is assumed.
    """

    ratios: tuple[float, ...] = option(
        (3.9, 2.269, 1.435, 0.978, 0.755, 0.622),
        'ratio of each gear, from the first gear on',
        source='published, C635',
        many=True,
        above=0.0,
    )
    final_drives: tuple[float, ...] = option(
        (4.118,) * 6,
        'ratio of the final drive of each gear',
        source='published for one output shaft of the C635, assumed for the other',
        many=True,
        above=0.0,
    )
    measured_gears: tuple[int, ...] = option(
        (2,),
        'gears whose total ratio is measured',
        source='`identify`',
        kind=int,
        many=True,
        at_least=1,
    )
    measured_ratios: tuple[float, ...] = option(
        (IDENTIFIED_RATIO,),
        'tau, total ratio of each of `measured_gears`, in place of the product of its two ratios',
        source='`identify`',
        many=True,
        above=0.0,
    )

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        super().__post_init__()
        if not self.ratios:
            raise ParameterError(
                'gearbox.ratios is empty: give the ratio of each gear', key='gearbox.ratios'
            )
        self.require_pairs('ratios', 'final_drives')
        self.require_pairs('measured_gears', 'measured_ratios')
        for at, number in enumerate(self.measured_gears):
            self.require_gear(f'gearbox.measured_gears[{at}]', number)
            if number in self.measured_gears[:at]:
                raise ParameterError(
                    f'gearbox.measured_gears has gear {number} twice: give each gear once',
                    key='gearbox.measured_gears',
                )

    @property
    def gears(self) -> int:
        """Number of forward gears."""
        return len(self.ratios)

    def require_gear(self, key: str, number: float) -> None:
        """Raise ParameterError for the value of `key` unless the car has a gear of this number."""
        if not 1 <= number <= self.gears:
            raise ParameterError(
                f'{key} is {number:g}, but the car has {self.gears} gear'
                f'{"s" if self.gears > 1 else ""}: give one that it has, or a car with that gear',
                key=key,
            )

    def gear(self, number: int) -> EngagedGear:
        """Return a gear by its number from 1 on."""
        if number in self.measured_gears:
            return EngagedGear(self.measured_ratios[self.measured_gears.index(number)])
        return EngagedGear(self.ratios[number - 1] * self.final_drives[number - 1])

    def with_measured(self, gear: EngagedGear) -> tuple['Gearbox', int]:
        """
        Return the gearbox that has a measured gear, and the number of that gear.

        It is this one with the measured ratio in the gear that is within 1 % of it; without such
        a gear it is a gearbox with that gear alone.
        """
        number = self.nearest(gear)
        if self.gear(number) == gear:
            return self, number
        if self._distance(number, gear) > _SAME_GEAR:
            return Gearbox((gear.total_ratio,), (1.0,), (), ()), 1
        measured = dict(zip(self.measured_gears, self.measured_ratios, strict=True))
        measured[number] = gear.total_ratio
        gears, ratios = tuple(measured), tuple(measured.values())
        return replace(self, measured_gears=gears, measured_ratios=ratios), number

    def nearest(self, gear: EngagedGear) -> int:
        """Return the number of the gear whose total ratio is nearest."""
        return min(range(1, self.gears + 1), key=lambda each: self._distance(each, gear))

    def _distance(self, number: int, gear: EngagedGear) -> float:
        return abs(self.gear(number).total_ratio / gear.total_ratio - 1.0)
