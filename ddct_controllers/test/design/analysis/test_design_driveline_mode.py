# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline's mode in a closed loop is found, with its amplitude in w_sr."""

import numpy as np
import pytest

from ddct_controllers.design.analysis.driveline_mode import (
    driveline_mode,
    locked_driveline_zero,
    nearest_mode,
)
from ddct_controllers.design.analysis.loops import IDENTIFIED_DRIVELINE, sampled_loop
from ddct_controllers.design.state_space import close_loop
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import RPM_PER_RAD_S
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters


def sampled(controller: FactoredTransferFunction) -> StateSpace:
    return sampled_loop(discretise_zoh(controller.to_state_space(), PERIOD_S))


def torsion_rpm(loop: StateSpace, steps: int) -> np.ndarray:
    """Return w_sr in rpm after a step of 1 rpm of the reference."""
    closed = close_loop(loop)
    row = RPM_PER_RAD_S * driveline_matrices(IDENTIFIED_DRIVELINE).c[1]
    state, torsion = np.zeros(len(closed.a)), []
    for _ in range(steps):
        torsion.append(row @ state[-4:])
        state = closed.a @ state + closed.b[:, 0]
    return np.array(torsion)


@pytest.mark.parametrize('name', ['ls4', 'ls8', 'hinf1', 'hinf3'])
def test_controllers_that_cancel_the_locked_driveline_keep_its_mode(name):
    """It has 2.93 Hz and a damping of 0.145: their own poles stay on the zeros of P_2."""
    mode = driveline_mode(sampled(PRINTED_CONTROLLERS[name]))
    assert mode.frequency_hz == pytest.approx(2.93, abs=0.01)
    assert mode.damping == pytest.approx(0.145, abs=0.002)


def test_the_cancelled_mode_rings_in_w_sr_with_the_computed_amplitude():
    """For LS8 the mode and the other slow poles are fitted to w_sr from 0.3 s on; within 2 %."""
    loop = sampled(PRINTED_CONTROLLERS['ls8'])
    mode = driveline_mode(loop)
    steps = np.arange(30, 400)
    torsion = torsion_rpm(loop, 400)[30:]
    poles = np.linalg.eigvals(close_loop(loop).a)
    slow = poles[np.abs(poles) > 0.9]
    basis = np.column_stack([np.ones(len(steps)), *(slow[:, None] ** steps)])
    weights = np.linalg.lstsq(basis, torsion.astype(complex), rcond=None)[0][1:]
    rates = np.log(slow) / PERIOD_S
    index = nearest_mode(rates, locked_driveline_zero(IDENTIFIED_DRIVELINE))
    assert mode.torsion_amplitude_rpm == pytest.approx(2.0 * abs(weights[index]), rel=0.02)


def test_a_controller_of_high_gain_pushes_poles_to_the_zeros():
    """With an ideal lead at growing gain the distance to the locked driveline's zero shrinks."""
    zero = locked_driveline_zero(IDENTIFIED_DRIVELINE)
    distances = []
    for gain in (-0.02, -0.1, -0.3):
        mode = driveline_mode(sampled(FactoredTransferFunction(gain)))
        omega = 2.0 * np.pi * mode.frequency_hz
        pole = omega * complex(-mode.damping, np.sqrt(1.0 - mode.damping**2))
        distances.append(abs(pole - zero))
    assert distances == sorted(distances, reverse=True)


def test_the_mode_is_that_of_the_driveline_given():
    stiff = DrivelineParameters(halfshaft_stiffness=2.0 * IDENTIFIED_DRIVELINE.halfshaft_stiffness)
    ratio = locked_driveline_zero(stiff) / locked_driveline_zero(IDENTIFIED_DRIVELINE)
    assert abs(ratio) == pytest.approx(np.sqrt(2.0), rel=1e-3)


def test_a_driveline_that_does_not_oscillate_has_no_mode():
    damped = DrivelineParameters(halfshaft_damping=50.0 * IDENTIFIED_DRIVELINE.halfshaft_damping)
    controller = discretise_zoh(PRINTED_CONTROLLERS['ls2'].to_state_space(), PERIOD_S)
    assert locked_driveline_zero(damped) is None
    assert driveline_mode(sampled_loop(controller, damped), damped) is None


def test_real_poles_are_no_mode():
    assert nearest_mode(np.array([-1.0, -2.0 + 0.0j]), -1.0 + 1.0j) == -1
    assert nearest_mode(np.array([-1.0, -2.0 - 3.0j, -2.0 + 3.0j]), -1.0 + 1.0j) == 2
