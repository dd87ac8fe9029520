"""What the calibration fits, within which bounds, to which numbers, and what it assumes."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.thesis.table_5_1 import CALIBRATED, THESIS_TABLE
from ddct_plant.models.engine import TorqueProfile
from ddct_plant.scenario.scenario import Scenario

TARGETS = {row.controller: row.figures() for row in THESIS_TABLE if row.use == CALIBRATED}
ROWS = tuple(TARGETS)
"""Controllers whose rows are fitted."""


@dataclass(frozen=True)
class FittedParameter:
    """One fitted number, its bounds and where they come from."""

    name: str
    symbol: str
    unit: str
    lower: float
    upper: float
    decimals: int
    """Decimals that the scenario file keeps."""
    bounds_from: str


PARAMETERS = (
    FittedParameter(
        'torque_start_n_m', 'C_m start', 'N m', 0.0, 60.0, 0, 'no engine braking; low torque'
    ),
    FittedParameter(
        'torque_end_n_m',
        'C_m end',
        'N m',
        150.0,
        350.0,
        0,
        'highest input torque of the C635 is 350 N m (Section 1.1)',
    ),
    FittedParameter(
        'rise_end_s',
        'rise end',
        's',
        0.30,
        0.60,
        3,
        '"sudden growth" in "the first 0.5 seconds" (Chapter 6); control starts at 0.6 s',
    ),
    FittedParameter(
        'slope_rad_s2', 'reference slope', 'rad/s^2', 40.0, 160.0, 0, 'wide; t_a decides'
    ),
    FittedParameter('proportional_gain', 'K_p', 'N m/rpm', 0.0, 0.3, 3, 'sign; wide above'),
    FittedParameter('integral_gain', 'K_i', 'N m/(rpm s)', 0.0, 0.5, 4, 'sign; wide above'),
)
PI_ONLY = (4, 5)
"""Indices of the parameters that no row but that of the PI depends on."""
LOWER = np.array([parameter.lower for parameter in PARAMETERS])
RANGE = np.array([parameter.upper for parameter in PARAMETERS]) - LOWER

DURATION_S = 3.0
"""Length of the thesis run; a score window cannot be longer."""
BASE = Scenario(
    name='thesis',
    description='Slip phase of Table 5.1, calibrated on its LS8, Hinf1 and PI rows',
    duration_s=DURATION_S,
    control_start_s=0.6,
    score_window_s=(0.6, DURATION_S),
    engine=TorqueProfile((0.0,), (0.0,)),
)
"""The fixed assumptions: both plates at 160 rad/s and the default road load among them."""
