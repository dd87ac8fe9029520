"""The transmission's model with an engine that a controller moves away from the demand."""

import numpy as np

from ddct_controllers.mpc.model.transmission_model import ENGINE_TORQUE, TransmissionModel


def with_engine(model: TransmissionModel, lag_share: float) -> TransmissionModel:
    """
    Return `model` with two more states, the driver's demand and the deviation before, in N m.

    Its input ENGINE_TORQUE is the deviation u that is asked for. With s = `lag_share`, the share
    that comes about within a period (1 without a lag), C_m = demand + (1 - s) deviation + s u over
    the period, and the deviation after it is (1 - s) deviation + s u. The demand stays as it is.
    """
    kept = 1.0 - lag_share
    states = len(model.a)
    engine, through = model.b[:, ENGINE_TORQUE], model.d[:, ENGINE_TORQUE]
    a = np.zeros((states + 2, states + 2))
    a[:states] = np.column_stack([model.a, engine, kept * engine])
    a[states, states], a[-1, -1] = 1.0, kept
    b = np.vstack([model.b, np.zeros((2, 3))])
    b[:states, ENGINE_TORQUE], b[-1, ENGINE_TORQUE] = lag_share * engine, lag_share
    d = model.d.copy()
    d[:, ENGINE_TORQUE] = lag_share * through
    c = np.column_stack([model.c, through, kept * through])
    return TransmissionModel(a, b, c, d, np.concatenate([model.clutch, np.zeros(2)]))
