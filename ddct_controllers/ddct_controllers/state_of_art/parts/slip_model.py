"""Slip and torsion of the driveline as seen from the clutch, without the speed of the vehicle."""

import numpy as np

from ddct_plant.linear.lti import StateSpace
from ddct_plant.models.parameters import DrivelineParameters

ENGINE, CLUTCH, LOAD = range(3)
"""Inputs C_m, C_f, C_load in N m."""


def slip_model(parameters: DrivelineParameters) -> StateSpace:
    """
    Return the driveline of Section 1.5 in x = [w_d, w_sr, theta_sr], y = w_d.

    c_m and c_prim are left out: they act on absolute speeds, which slip does not show, and only
    move a pole from 0 to -0.007 1/s. What they brake is a constant torque to this model.
    """
    p = parameters
    tau, damping, stiffness = p.total_ratio, p.halfshaft_damping, p.halfshaft_stiffness
    to_shaft = 1.0 / (p.shaft_inertia * tau)
    to_torsion = to_shaft / tau + 1.0 / p.vehicle_inertia
    a = [
        [0.0, damping * to_shaft, stiffness * to_shaft],
        [0.0, -damping * to_torsion, -stiffness * to_torsion],
        [0.0, 1.0, 0.0],
    ]
    b = [
        [1.0 / p.engine_inertia, -1.0 / p.engine_inertia - 1.0 / p.shaft_inertia, 0.0],
        [0.0, to_shaft, 1.0 / p.vehicle_inertia],
        [0.0, 0.0, 0.0],
    ]
    return StateSpace(np.array(a), np.array(b), np.eye(1, 3), np.zeros((1, 3)))
