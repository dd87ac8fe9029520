"""How much of a disturbance's effect on the slip a feedforward filter leaves, over frequency."""

import numpy as np

from ddct_controllers.design.analysis.loops import sampled_plant
from ddct_controllers.design.state_space import frequency_response
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace, discretise_zoh
from ddct_plant.models.driveline_model import engine_to_slip, load_to_slip
from ddct_plant.models.parameters import DrivelineParameters


def engine_residual(
    feedforward: StateSpace, omega: np.ndarray, driveline: DrivelineParameters
) -> np.ndarray:
    """
    Return (P_1 + P_2 G_a F_1) / P_1, complex, the shape of `omega` in rad/s.

    F_1 = -C_1 is the filter's path from C_m. Everything is sampled at 10 ms, with hold and
    actuator delay, and the driveline has its drags. 0 is full compensation, 1 none at all.
    """
    return _residual(feedforward, 0, engine_to_slip(driveline), omega, driveline)


def load_residual(
    feedforward: StateSpace, omega: np.ndarray, driveline: DrivelineParameters
) -> np.ndarray:
    """Return (P_3 + P_2 G_a F_2) / P_3, F_2 = -C_2 being the path from C_load; see above."""
    return _residual(feedforward, 1, load_to_slip(driveline), omega, driveline)


def _residual(
    feedforward: StateSpace,
    column: int,
    disturbance_path: FactoredTransferFunction,
    omega: np.ndarray,
    driveline: DrivelineParameters,
) -> np.ndarray:
    path = StateSpace(
        feedforward.a,
        feedforward.b[:, [column]],
        feedforward.c,
        feedforward.d[:, [column]],
        feedforward.period_s,
    )
    uncompensated = discretise_zoh(disturbance_path.to_state_space(), PERIOD_S)
    compensation = rad_s_from_rpm(frequency_response(sampled_plant(driveline), omega))
    compensation = compensation * frequency_response(path, omega)
    return 1.0 + compensation / frequency_response(uncompensated, omega)
