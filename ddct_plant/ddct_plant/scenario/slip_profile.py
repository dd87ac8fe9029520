"""Slip speed that the reference `profile` asks for, as the scenario gives it."""

from dataclasses import dataclass

from ddct_plant.base.options import option
from ddct_plant.base.profile import Profile


@dataclass(frozen=True)
class SlipProfile(Profile, prefix='slip_reference.'):
    """Slip speed over scenario time, linear between its points; it counts from control start."""

    time_s: tuple[float, ...] = option(
        (), 'scenario times of the points', 's', many=True, rising=True
    )
    slip_rad_s: tuple[float, ...] = option(
        (),
        'slip speed that the reference has then if `reference.shape` is `profile`, linear between '
        'its points; it counts from control start, where it may start with a step',
        'rad/s',
        many=True,
        at_least=-1000.0,
        at_most=1000.0,
    )
