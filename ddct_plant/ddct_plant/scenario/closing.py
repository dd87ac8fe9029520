"""What the closing stage goes by: when a clutch counts as locked, and what it is then asked."""

from dataclasses import dataclass

from ddct_plant.base.options import ASSUMED, OptionGroup, option


@dataclass(frozen=True)
class ClosingParameters(OptionGroup, prefix='closing.'):
    """How lock-up is recognised from measured speeds, and the request that keeps it."""

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
        'what is asked beyond that, so that a clutch without load is closed too',
        'N m',
        source=ASSUMED,
        at_least=0.0,
        at_most=1000.0,
    )
    most_n_m: float = option(
        500.0,
        'highest request of the stage, unless C_fOL itself is higher: with it a clutch worn to a '
        'wear gain of 0.7 carries the 350 N m of `friction.most_n_m`',
        'N m',
        source='published capacity of the C635; wear assumed',
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
