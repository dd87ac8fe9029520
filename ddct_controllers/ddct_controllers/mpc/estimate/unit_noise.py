"""The filter that the MPC Toolbox gives an MPC for which nothing else is said."""

import numpy as np

from ddct_controllers.mpc.model.transmission_model import MEASURED, SLIP_SPEED, TransmissionModel
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.units import rpm_from_rad_s


def unit_noise_gain(model: TransmissionModel, noise_rpm: float = 1.0) -> np.ndarray:
    """
    Return the stationary filter gain (n, 3) for w_d in rpm as the only measured output.

    By default the toolbox's estimator believes in white noise of unit variance on each
    manipulated variable and measured disturbance, held over a period, and on each measured
    output:

        x_(k+1) = a x_k + b (u_k + w_k), y_k = c x_k + v_k, E[w w'] = I, E[v v'] = 1.

    So its Kalman filter has Q = b b' (1 N m on C_f, C_m and, where it is known, C_load) and R = 1
    (1 rpm on w_d, `noise_rpm`), and l = p c' (c p c' + R)^-1 with

        p = a p a' - a p c' (c p c' + R)^-1 c p a' + Q.

    The integrator that it would add to the output is dropped: C_m to w_d is an integrator
    already, P_1 = 4/s, and two that act on one output cannot be told apart.

    l acts on the error of w_d, which is [1, -1, 0] times that of w_m, w_p and w_r. Raise
    ParameterError when there is no stationary gain.
    """
    # Imported here: only runs with this filter need it.
    from scipy.linalg import solve_discrete_are

    output = rpm_from_rad_s(1.0) * model.c[SLIP_SPEED : SLIP_SPEED + 1]
    noise = noise_rpm**2 * np.eye(1)
    try:
        covariance = solve_discrete_are(model.a.T, output.T, model.b @ model.b.T, noise)
    except (np.linalg.LinAlgError, ValueError) as failure:
        raise ParameterError(
            f'observer: no stationary Kalman gain of w_d for this driveline ({failure}): measure '
            'the speeds'
        ) from failure
    gain = covariance @ output.T / (output @ covariance @ output.T + noise)
    effective: np.ndarray = gain @ output[:, :MEASURED]
    return effective
