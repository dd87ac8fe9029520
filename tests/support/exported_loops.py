# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Loops of exported controllers beside those of their Python originals."""

import numpy as np
import pytest

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless
from ddct_controllers.interface import Controller
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.scenario.settings import RunSettings
from support.exported_mpc import NOT_IN_C

TOLERANCE_N_M = 1e-6
"""Tolerance in N m: both solvers leave about 1e-9, DAQP by its tolerance."""
CONTROL_STARTS = 60
"""First step under feedback in the detailed architecture."""
EXPORTABLE = sorted(set(PREDICTIVE) - NOT_IN_C)


def pairs(run: Trajectory, key: str) -> list[str | None]:
    """Return one value of the controller's status at every step."""
    return [dict(status).get(key) for status in run.status]


def compare_loops(original: Controller, in_c: Controller, settings: RunSettings) -> Trajectory:
    """Run both controllers in loops of their own; return the original's run."""
    expected, found = run_headless(settings, original), run_headless(settings, in_c)
    error = np.abs(found.torque_request - expected.torque_request)
    assert error.max() <= TOLERANCE_N_M, f'{error.max():g} N m at step {error.argmax()}'
    if original.commands_engine:
        for mine, other in zip(
            found.engine_torque_request, expected.engine_torque_request, strict=True
        ):
            assert mine == pytest.approx(other, abs=TOLERANCE_N_M)
    assert pairs(found, 'qp_status') == pairs(expected, 'qp_status')
    assert pairs(found, 'fallbacks') == pairs(expected, 'fallbacks')
    assert np.ptp(expected.torque_request[-150:]) > 1.0, 'this run asks nothing of the controller'
    return expected
