"""What the controllers that predict with the estimated wear gain have in common."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ddct_controllers.interface import Measurement, Status
from ddct_controllers.mpc.estimate.wear_noise import WearNoise
from ddct_controllers.mpc.estimate.wear_observer import WearObserver
from ddct_controllers.mpc.options import MOST, number_option

WEAR_OPTIONS = ('gain_drift', 'clutch_drift_n_m', 'load_drift_n_m')
"""Fields of `WearNoise` that `controllers.<name>` may give."""
MOST_GAIN_DRIFT = 1.0
"""Per period, as much as the bounds of the estimate are apart."""


def wear_noise(name: str, options: Mapping[str, Any], default: WearNoise) -> WearNoise:
    """Return `default` changed by `controllers.<name>`; raise ParameterError for a bad level."""
    most = {'gain_drift': MOST_GAIN_DRIFT}
    given = {
        key: number_option(
            name, options, key, getattr(default, key), at_least=0.0, at_most=most.get(key, MOST)
        )
        for key in WEAR_OPTIONS
    }
    return replace(default, **given)


def divided(measurement: Measurement, gain: float) -> Measurement:
    """
    Return what drives the slip divided by K_usura = `gain`: C_m, C_load and the references.

    Slip is linear in K_usura times the request. With these and the driveline's states divided by
    K_usura, the request obeys the equations of a new clutch.
    """
    return replace(
        measurement,
        engine_torque=measurement.engine_torque / gain,
        load_torque=measurement.load_torque / gain,
        slip_reference=[speed / gain for speed in measurement.slip_reference],
        slip_reference_rate=[rate / gain for rate in measurement.slip_reference_rate],
    )


def wear_status(observer: WearObserver) -> Status:
    """Return the estimate, its standard deviation and whether a bound holds it."""
    return (
        ('wear_gain_estimate', repr(observer.wear_gain)),
        ('wear_gain_deviation', repr(observer.wear_gain_deviation)),
        ('wear_gain_at_bound', str(observer.wear_gain_at_bound).lower()),
    )
