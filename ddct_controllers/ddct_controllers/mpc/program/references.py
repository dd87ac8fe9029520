"""References of the weighted outputs over the horizon."""

import numpy as np

from ddct_controllers.interface import Measurement
from ddct_controllers.mpc.model.transmission_model import SLIP_ACCELERATION, SLIP_SPEED
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_plant.base.timebase import PERIOD_S


def references(settings: MpcSettings, measurement: Measurement) -> np.ndarray:
    """
    Return them at the periods 1..p, (p, outputs).

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
