# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Conditioning of python-control's polynomials, which is worse than that of our own code."""

import numpy as np
import pytest

from ddct_controllers.design.analysis.loops import continuous_loop, sampled_loop
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.state_space import frequency_response
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.linear.sampling import discretise_zoh

OMEGA = np.geomspace(1e-4, 300.0, 200)


def product_of_factors(function: FactoredTransferFunction) -> np.ndarray:
    """Return the response in closed form, from the roots that the product was printed with."""
    s = 1j * OMEGA
    value = np.full(OMEGA.shape, function.gain, dtype=complex)
    for zero in function.zeros:
        value *= s - zero
    for pole in function.poles:
        value /= s - pole
    return value


@pytest.mark.parametrize(('name', 'theirs_above'), [('hinf1', 0.01), ('hinf2', 1.0)])
def test_a_printed_loop_realised_by_python_control_is_off_by_percents(name, theirs_above):
    """From 1e-4 to 300 rad/s errors are 3.9 % and 1200 %; with ours 6e-14 and 3e-14."""
    import control

    function = continuous_loop(PRINTED_CONTROLLERS[name]).transfer_function
    exact = product_of_factors(function)
    ours = frequency_response(function.to_state_space(), OMEGA)
    theirs = control.ss(control.zpk(function.zeros, function.poles, function.gain))(1j * OMEGA)
    assert np.abs(ours / exact - 1.0).max() < 1e-12
    assert np.abs(theirs / exact - 1.0).max() > theirs_above


@pytest.mark.filterwarnings('ignore:stability_margins')
@pytest.mark.parametrize(('name', 'wrong_by'), [('ls2', 0.7), ('hinf2', 0.3), ('hinf3', 6.0)])
def test_the_crossover_by_python_control_of_a_sampled_loop_is_none(name, wrong_by):
    """It is where |L| = 1; python-control's own |L| is 0.26, 0.67 and 7.9 at the one it gives."""
    import control

    controller = discretise_zoh(PRINTED_CONTROLLERS[name].to_state_space(), PERIOD_S)
    loop = sampled_loop(controller)
    system = control.ss(loop.a, loop.b, loop.c, loop.d, dt=loop.period_s)
    theirs = control.stability_margins(system)[4]
    ours = loop_margins(loop).crossover_rad_s
    assert abs(system(np.exp(1j * ours * PERIOD_S))) == pytest.approx(1.0, abs=1e-9)
    assert abs(abs(system(np.exp(1j * theirs * PERIOD_S))) - 1.0) > wrong_by
