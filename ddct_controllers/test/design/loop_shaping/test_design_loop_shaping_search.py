# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A user's specifications give a controller that meets them in the sampled loop, or an error."""

import numpy as np
import pytest
from refusals import refused
from samples import sampled

from ddct_controllers.design.analysis.loops import sampled_loop
from ddct_controllers.design.loop_shaping.candidates import Candidates
from ddct_controllers.design.loop_shaping.search import STRUCTURES, design_loop_shaping
from ddct_controllers.design.loop_shaping.specifications import (
    TimeSpecifications,
)
from ddct_controllers.design.loop_shaping.verification import verify
from ddct_controllers.design.state_space import close_loop
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.parameters import DrivelineParameters

pytestmark = pytest.mark.slow

DRIVELINE = DrivelineParameters()


def independent_figures(controller: FactoredTransferFunction) -> tuple[float, float]:
    """Return the first sample above 1 in s and the highest, by stepping the closed loop."""
    closed = close_loop(sampled_loop(discretise_zoh(controller.to_state_space(), PERIOD_S)))
    assert np.abs(np.linalg.eigvals(closed.a)).max() < 1.0
    powers = [closed.b[:, 0]]
    for _ in range(6000):
        powers.append(closed.a @ powers[-1])
    output = np.concatenate([[0.0], np.cumsum(np.array(powers) @ closed.c[0])])
    return PERIOD_S * float(np.argmax(output >= 1.0)), float(output.max())


@pytest.mark.parametrize(
    ('rise_time', 'overshoot', 'integrators', 'structure'),
    [
        (0.6, 0.14, 1, 'networks'),
        (0.25, 0.14, 1, 'placement'),
        *sampled(
            [
                (0.6, 0.14, 2, 'networks'),
                (0.3, 0.08, 1, 'placement'),
                (1.0, 0.05, 1, 'networks'),
                (0.15, 0.20, 1, 'placement'),
                (0.6, 0.14, 0, 'placement'),
            ],
            every=4,
        ),
    ],
)
def test_specifications_are_met_in_the_loop_as_it_runs(
    rise_time, overshoot, integrators, structure
):
    design = design_loop_shaping(TimeSpecifications(rise_time, overshoot), integrators, DRIVELINE)
    first_above, highest = independent_figures(design.controller)
    assert first_above <= rise_time + PERIOD_S
    assert highest <= 1.0 + overshoot
    assert design.verification.rejections == ()
    assert design.verification.margins.sensitivity_peak <= 2.0
    assert design.structure == structure
    assert np.count_nonzero(design.controller.poles == 0.0) == integrators


def test_a_loop_that_can_stays_out_of_both_curves():
    found = design_loop_shaping(TimeSpecifications(0.6, 0.14), 1, DRIVELINE).verification
    assert found.respects_contours
    assert found.margins.complementary_peak <= found.specifications.complementary_peak


def test_the_time_specifications_come_first_where_both_curves_cannot_be_kept_out_of():
    """Two integrators in the loop make |T| exceed 1, the T_p of 2 % overshoot."""
    found = design_loop_shaping(TimeSpecifications(0.6, 0.02), 1, DRIVELINE).verification
    assert found.rejections == ()
    assert not found.respects_contours


def test_a_small_overshoot_has_zeros_at_a_five_hundredth_of_the_crossover():
    """Slower zeros overshoot by 0.59 % at 4 rad/s, zeros at twice the frequency by 0.78 %."""
    candidates = Candidates(TimeSpecifications(0.7, 0.006), 1, DRIVELINE)
    found = candidates._quickest('networks', 4.0, within_contours=False)
    assert found is not None
    controller, rise_time_s = found
    assert np.abs(controller.zeros).min() == pytest.approx(4.0 / 500.0)
    assert rise_time_s == pytest.approx(0.66, abs=0.01)


@pytest.mark.parametrize('structure', STRUCTURES)
def test_one_structure_can_be_selected(structure):
    design = design_loop_shaping(TimeSpecifications(0.6, 0.14), 1, DRIVELINE, (structure,))
    assert design.structure == structure


def test_networks_alone_cannot_have_0_2_s_and_14_percent_as_the_thesis_found():
    specifications = TimeSpecifications(0.2, 0.14)
    with refused(ParameterError, 'rise time'):
        design_loop_shaping(specifications, 1, DRIVELINE, ('networks',))
    assert design_loop_shaping(specifications, 1, DRIVELINE).structure == 'placement'


def test_specifications_that_the_actuator_forbids_are_refused_at_once():
    with refused(ParameterError, 'rise time'):
        design_loop_shaping(TimeSpecifications(0.05, 0.14), 1, DRIVELINE)


def test_between_bound_and_structure_the_error_has_reachable_specifications():
    with refused(ParameterError, 'rise time') as caught:
        design_loop_shaping(TimeSpecifications(0.1, 0.14), 1, DRIVELINE)
    assert '0.104 s' in str(caught.value)
    design = design_loop_shaping(TimeSpecifications(0.104, 0.14), 1, DRIVELINE)
    assert design.verification.rejections == ()


@pytest.mark.parametrize(
    ('rise_time', 'overshoot', 'structures', 'reachable'),
    [
        (0.6, 0.0005, STRUCTURES, r'15\.\d+'),
        (0.05, 0.9, STRUCTURES, r'0\.0\d+'),
        pytest.param(  # one structure: it tries every crossover
            *(4.0, 1e-6, ('networks',), 'nor a slower one'), marks=pytest.mark.nightly
        ),
    ],
)
def test_unreachable_specifications_are_named_with_reachable_ones(
    rise_time, overshoot, structures, reachable
):
    """Two integrators overshoot; 0.05 s would need an M_s above 2."""
    with pytest.raises(ParameterError, match=f'{reachable}.*more overshoot'):
        design_loop_shaping(TimeSpecifications(rise_time, overshoot), 1, DRIVELINE, structures)


@pytest.mark.parametrize(
    ('name', 'complaint'),
    [
        ('ls1', 'rise time 0.5'),
        ('ls3', 'overshoot above 20 %'),
        ('hinf2', 'sensitivity peak M_s above 2'),
    ],
)
def test_a_refused_controller_comes_with_the_reason(name, complaint):
    found = verify(PRINTED_CONTROLLERS[name], TimeSpecifications(0.3, 0.2), DRIVELINE)
    assert any(text.startswith(complaint) for text in found.rejections)


def test_an_unstable_loop_is_never_accepted():
    flipped = FactoredTransferFunction(0.01, (0.8,), (0.0,))
    found = verify(flipped, TimeSpecifications(5.0, 0.9), DRIVELINE)
    assert found.rejections == ('the closed loop is unstable',)
    assert not found.respects_contours


def test_a_loop_that_wear_makes_unstable_is_not_accepted():
    """LS2 with 2.7 times its gain: 1.2 dB of gain margin are less than a wear gain of 1.3."""
    g_c = PRINTED_CONTROLLERS['ls2']
    strong = FactoredTransferFunction(2.7 * g_c.gain, g_c.numerator, g_c.denominator)
    found = verify(strong, TimeSpecifications(5.0, 0.99), DRIVELINE)
    assert found.margins.stable
    assert 'unstable with wear gain 1.3' in found.rejections
