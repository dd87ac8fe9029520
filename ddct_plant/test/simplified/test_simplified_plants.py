# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The simplified plants against the detailed one over a slip phase (Figure 1.23)."""

import numpy as np
import pytest
import scipy
from refusals import refused
from scipy.linalg import expm

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.initial_state import InitialSide, InitialState
from ddct_plant.models.linear_driveline import Driveline
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters
from ddct_plant.simplified.elementary import BlockDiagram, elementary_slip
from ddct_plant.simplified.plants import (
    SimplifiedPlant,
    SlipPhase,
    lti_slip,
    printed_lti_slip,
    state_space_slip,
)

PARAMETERS = DrivelineParameters()
PERIODS = 110
LOAD_N_M = 60.0
LAG_S = 0.04
CLUTCH_SHARE = 0.877


def engine_ramp(time: np.ndarray) -> np.ndarray:
    """Return C_m: 10 N m rising to 270 N m in 0.52 s."""
    return np.interp(time, (0.0, 0.52), (10.0, 270.0))


STARTS = np.arange(PERIODS) * 0.01
ENGINE = engine_ramp(STARTS)
CLUTCH = CLUTCH_SHARE * engine_ramp(STARTS[:, None] + np.arange(11) * 0.001 - LAG_S)
LOAD = np.full(PERIODS, LOAD_N_M)
START = np.array(
    [160.0, 160.0, PARAMETERS.gear.wheel_speed(160.0), LOAD_N_M / PARAMETERS.halfshaft_stiffness]
)


@pytest.fixture(scope='module')
def detailed() -> np.ndarray:
    """Return w_d of the detailed plant over the slip phase, (111,)."""
    engine, shaft, wheel, twist = START
    side = InitialSide(shaft, CLUTCH[0, 0], CLUTCH[0, 0])
    start = InitialState(engine, wheel, twist, ENGINE[0], LOAD_N_M, (side,))
    driveline = Driveline(PARAMETERS, VehicleParameters(), start)
    slip_speed = [driveline.outputs().slip_speed]
    for engine, points, load in zip(ENGINE, CLUTCH, LOAD, strict=True):
        driveline.step(engine, load, points.tolist())
        slip_speed.append(driveline.outputs().slip_speed)
    return np.array(slip_speed)


def deviation(plant: SimplifiedPlant, detailed: np.ndarray) -> float:
    """Return the largest difference in w_d as a fraction of the slip peak."""
    slip_speed = plant(PARAMETERS, SlipPhase(ENGINE, CLUTCH, LOAD, START))
    assert slip_speed.shape == (PERIODS + 1,)
    return float(np.abs(slip_speed - detailed).max() / np.abs(detailed).max())


def test_slip_phase_is_the_one_of_the_figure(detailed):
    assert 30.0 < detailed.max() < 60.0
    assert detailed[-1] > 0.0


def test_elementary_blocks_agree_to_1e_10_of_the_slip_peak(detailed):
    assert deviation(elementary_slip, detailed) < 1e-10


def test_state_space_blocks_agree_to_1e_12_of_the_slip_peak(detailed):
    assert deviation(state_space_slip, detailed) < 1e-12


def test_lti_blocks_with_the_free_response_agree_to_1e_11_of_the_slip_peak(detailed):
    assert deviation(lti_slip, detailed) < 1e-11


def by_lsim(poles: np.ndarray) -> np.ndarray:
    """Return w_d by scipy: P_1, P_2 and P_3 typed from Section 1.6.2, and the free response."""
    from scipy.signal import lsim

    time = np.arange(10 * PERIODS + 1) * 0.001
    clutch = np.append(CLUTCH[:, :10].ravel(), CLUTCH[-1, -1])
    engine, load = (np.append(np.repeat(held, 10), held[-1]) for held in (ENGINE, LOAD))
    zeros = -103.43 * np.polymul([1.0, 0.005905], [1.0, 5.344, 339.4])
    forced = (
        lsim(([4.0], [1.0, 0.0]), engine, time, interp=False)[1]
        + lsim((zeros, np.append(poles, 0.0)), clutch, time)[1]
        + lsim((7.2217 * np.array([1.0, 63.99]), poles), load, time, interp=False)[1]
    )
    model = driveline_matrices(PARAMETERS)
    free = [(model.c[0] @ expm(model.a * t) @ START) for t in np.arange(PERIODS + 1) * 0.01]
    return forced[::10] + free


def test_rounding_of_the_printed_coefficients_costs_0_23_percent_of_the_peak(detailed):
    """A simulation of the printed polynomials by scipy has the same cost."""
    simulated = by_lsim(np.polymul([1.0, 0.006733], [1.0, 121.4, 7696.0]))
    cost = np.abs(simulated - detailed).max() / np.abs(detailed).max()
    assert cost == pytest.approx(0.0023, abs=5e-5)
    assert deviation(printed_lti_slip, detailed) == pytest.approx(cost, rel=1e-6)


def test_lti_blocks_without_the_free_response_miss_the_slip_phase(detailed):
    forced = lti_slip(PARAMETERS, SlipPhase(ENGINE, CLUTCH, LOAD, np.zeros(4)))
    assert np.abs(forced - detailed).max() > 0.05 * np.abs(detailed).max()


def test_initial_condition_counts_once_in_the_state_space_blocks():
    model = driveline_matrices(PARAMETERS)
    start = np.array([200.0, 150.0, 16.0, 0.02])
    free = scipy.integrate.solve_ivp(
        lambda t, x: model.a @ x,
        (0.0, 0.3),
        start,
        method='DOP853',
        t_eval=np.arange(31) * 0.01,
        rtol=1e-12,
        atol=1e-12,
    ).y
    silent = SlipPhase(np.zeros(30), np.zeros((30, 11)), np.zeros(30), start)
    for plant in (state_space_slip, lti_slip):
        np.testing.assert_allclose(plant(PARAMETERS, silent), free[0] - free[1], atol=1e-8)


def test_torques_of_different_lengths_are_refused():
    with refused(ParameterError, 'clutch_points'):
        SlipPhase(ENGINE, CLUTCH[:, :10], LOAD, START)
    with refused(ParameterError, 'load_torque'):
        SlipPhase(ENGINE, CLUTCH, LOAD[:5], START)


def test_block_diagram_evaluates_blocks_in_any_order():
    diagram = BlockDiagram(
        {'force': {'push': 1.0, 'drag': -1.0}, 'drag': {'speed': 0.5}},
        {'speed': 'force'},
        ('push',),
    )
    assert diagram.derivative(np.array([4.0]), [3.0]).tolist() == [1.0]
    assert diagram.signals([4.0], [3.0])['drag'] == 2.0


def test_block_diagram_refuses_loops_and_unknown_signals():
    with pytest.raises(ParameterError, match='algebraic loop'):
        BlockDiagram({'a': {'b': 1.0}, 'b': {'a': 1.0}}, {}, ())
    with refused(ParameterError, 'c'):
        BlockDiagram({'a': {'c': 1.0}}, {}, ())
    with refused(ParameterError, 'c'):
        BlockDiagram({}, {'x': 'c'}, ())
