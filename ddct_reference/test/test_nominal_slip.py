# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The slip under C_fOL alone: constant for constant torques with the full equilibrium."""

import pytest

from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings
from ddct_reference.factory import make_reference, nominal_slip

CONSTANT = (
    *('engine.time_s=[0.0]', 'engine.torque_n_m=[150.0]', 'control_start_s=1.0'),
    'initial.engine_speed_rad_s=200.0',
)


def largest_change(*overrides: str) -> float:
    slips = nominal_slip(load_scenario('thesis', [*CONSTANT, *overrides]))
    return max(abs(slip - slips[0]) for slip in slips)


@pytest.mark.parametrize('engine_damping', [0.0, 0.05])
def test_full_equilibrium_holds_the_slip_of_40_rad_s_for_a_second(engine_damping):
    damping = f'driveline.engine_damping={engine_damping}'
    assert largest_change(damping, 'equilibrium=full') < 0.6
    assert largest_change(damping) > 40.0


def test_it_is_that_of_the_true_speeds():
    slips = nominal_slip(load_scenario('thesis', ['sensors.engine_speed.gain=1.1']))
    assert slips == nominal_slip(load_scenario('thesis'))


def test_it_is_that_of_the_known_actuator():
    """With 20 ms more delay the torque rises later, so the slip is higher when control starts."""
    known, usual = load_scenario('thesis', ['actuator.delay_s=0.03']), load_scenario('thesis')
    assert nominal_slip(known)[-1] > nominal_slip(usual)[-1] + 1.0
    unknown = RunSettings(KnownSettings(usual, 'feedforward'), CaseSettings(scenario=known))
    stored, slower = (
        make_reference(each).update(40, 0.0, 0.0)
        for each in (unknown.known, KnownSettings(known, 'feedforward'))
    )
    assert stored != slower
    assert stored[0][0] == nominal_slip(usual)[40]
