# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Sections of a scenario about control: the followed speeds, and the closing stage."""

from dataclasses import dataclass

from ddct_plant.base.options import ASSUMED, OptionGroup, option
from ddct_plant.base.profile import Profile
from ddct_plant.base.timebase import LONGEST_S
from ddct_plant.models.clutch import FrictionParameters

REFERENCE_SHAPES = ('ramp', 'tanh', 'polynomial')
"""Shapes of a slip reference that runs to zero from control start, as a function of time."""
ENGINE_SPEED_TARGET = 'engine_speed_target'
"""Shape of a slip reference that follows from a target of the engine speed."""
PROFILE = 'profile'
"""Shape of a slip reference that is a profile over scenario time."""


@dataclass(frozen=True)
class ReferenceParameters(OptionGroup, prefix='reference.'):
    """Shape of the slip-speed reference once control starts (Section 1.4.1)."""

    slope_rad_s2: float = option(
        90.0,
        'slope of the CRF ramp; also how fast `engine_speed_target` leads the engine to the '
        'wanted speed',
        'rad/s²',
        source=ASSUMED,
        above=0.0,
        at_most=1e4,
    )
    shape: str = option(
        'ramp',
        'how the reference runs to zero; the architecture `feedforward_tanh` makes the ramp a '
        'tanh; `engine_speed_target`, in `detailed` only, is `engine_speed_reference` less the '
        'measured shaft speed; `profile` is `slip_reference`',
        source='Section 1.4.1',
        choices=(*REFERENCE_SHAPES, ENGINE_SPEED_TARGET, PROFILE),
    )
    reference_end_s: float = option(
        1.6,
        'when `tanh` and `polynomial` reach zero: a multiple of 10 ms, after `control_start_s`; '
        'the ramp ends by its slope',
        's',
        source=ASSUMED,
        above=0.0,
        at_most=LONGEST_S,
        whole_periods=True,
    )


@dataclass(frozen=True)
class EngineSpeedReference(Profile, prefix='engine_speed_reference.'):
    """
    Engine speed over scenario time, linear between its points and constant outside them.

    Without points the controllers follow what the driver's demand and the slip reference imply.
    """

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
    """Slip reference over scenario time, linear between points, used from control start."""

    slip_rad_s: tuple[float, ...] = option(
        (),
        'slip speed that the reference has then if `reference.shape` is `profile`, linear between '
        'its points; it counts from control start, where it may start with a step',
        'rad/s',
        many=True,
        at_least=-1000.0,
        at_most=1000.0,
    )


@dataclass(frozen=True)
class ClosingParameters(OptionGroup, prefix='closing.'):
    """Closing stage: detection of lock-up from measured speeds, and the request that keeps it."""

    slip_band_rad_s: float = option(
        1.0,
        'largest size of the measured slip speed, and of its reference, of a clutch that counts '
        'as locked: seven times the deviation of w_m - w_p where each is known to 0.1 rad/s',
        'rad/s',
        source=ASSUMED,
        above=0.0,
        at_most=100.0,
    )
    dwell_s: float = option(
        0.1,
        'how long both must stay within it, a multiple of 10 ms; a slip that runs through zero '
        'faster than 20 rad/s² is out of the band before',
        's',
        source=ASSUMED,
        at_least=0.0,
        at_most=10.0,
        whole_periods=True,
    )
    margin: float = option(
        1.5,
        'request over the size of C_fOL; a clutch worn to a wear gain of 0.67 still holds C_fOL',
        source=ASSUMED,
        at_least=1.0,
        at_most=10.0,
    )
    reserve_n_m: float = option(
        20.0,
        'request beyond that, so that a clutch without load is closed too',
        'N m',
        source=ASSUMED,
        at_least=0.0,
        at_most=1000.0,
    )
    most_n_m: float | None = option(
        None,
        'highest request of the stage, unless C_fOL itself is higher; with the default a clutch '
        'worn to a wear gain of 0.7 carries `friction.most_n_m`',
        'N m',
        otherwise='`friction.most_n_m`/0.7',
        source=ASSUMED,
        above=0.0,
        at_most=10000.0,
    )
    ramp_n_m_s: float = option(
        1000.0,
        'how fast the margin comes and goes; C_fOL itself is followed at once',
        'N m/s',
        source=ASSUMED,
        above=0.0,
        at_most=1e6,
    )
    engine_fade_s: float = option(
        0.3,
        'how long a controller that commands the engine takes to hand it back to the driver, a '
        'multiple of 10 ms; about a period of the locked driveline, which a step would excite',
        's',
        source=ASSUMED,
        at_least=0.0,
        at_most=10.0,
        whole_periods=True,
    )

    def most_request(self, friction: FrictionParameters) -> float:
        """Return the highest request of the stage in N m, `most_n_m` or that of the clutch."""
        return friction.worn_request if self.most_n_m is None else self.most_n_m
