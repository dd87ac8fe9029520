"""What is known of the horizon ahead: the torques that drive the slip, and its references."""

from dataclasses import replace

import numpy as np

from ddct_controllers.interface import Measurement
from ddct_controllers.mpc.model.transmission_model import SLIP_ACCELERATION, SLIP_SPEED
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_plant.base.timebase import PERIOD_S


def divided(measurement: Measurement, gain: float) -> Measurement:
    """
    Return what drives the slip divided by K_usura = `gain`: C_m, C_load and the references.

    Slip is linear in K_usura times the request. With these and the driveline's states divided by
    K_usura, the request obeys the equations of a new clutch.
    """
    if gain == 1.0:
        return measurement
    return replace(
        measurement,
        engine_torque=measurement.engine_torque / gain,
        load_torque=measurement.load_torque / gain,
        slip_reference=[speed / gain for speed in measurement.slip_reference],
        slip_reference_rate=[rate / gain for rate in measurement.slip_reference_rate],
    )


def references(settings: MpcSettings, measurement: Measurement) -> np.ndarray:
    """
    Return the references of the weighted outputs at the periods 1..p, (p, outputs).

    They are the coming ones with preview, else the present ones, or that of the slip along its
    tangent; those of other outputs than the slip and its rate are zero.
    """
    values = np.zeros((settings.prediction_steps, len(settings.outputs)))
    coming = slice(1, None) if settings.preview else slice(0, 1)
    for column, terms in enumerate(settings.outputs):
        if terms.output == SLIP_SPEED:
            values[:, column] = measurement.slip_reference[coming]
            if settings.along_tangent and not settings.preview:
                steps = np.arange(1, settings.prediction_steps + 1)
                values[:, column] += PERIOD_S * measurement.slip_reference_rate[0] * steps
        elif terms.output == SLIP_ACCELERATION:
            values[:, column] = measurement.slip_reference_rate[coming]
    return values
