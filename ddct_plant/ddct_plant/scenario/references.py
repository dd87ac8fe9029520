"""Speeds over scenario time that controllers and references follow, as the scenario gives them."""

from dataclasses import dataclass

from ddct_plant.base.options import option
from ddct_plant.base.profile import Profile


@dataclass(frozen=True)
class EngineSpeedReference(Profile, prefix='engine_speed_reference.'):
    """
    Engine speed over scenario time, linear between its points and constant outside them.

    Without points the controllers follow what the driver's demand and the slip reference imply.
    """

    time_s: tuple[float, ...] = option(
        (), 'scenario times of the points', 's', many=True, rising=True
    )
    speed_rad_s: tuple[float, ...] = option(
        (),
        'engine speed w_m that `decoupled_pid`, `torque_estimator` and the reference '
        '`engine_speed_target` follow, linear between its points; without points the two derive '
        'it from the demand and the slip reference',
        'rad/s',
        many=True,
        at_least=0.0,
        at_most=1000.0,
    )


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
