# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The start of a run and C_fOL: as in the thesis, or in equilibrium on the full model."""

from dataclasses import replace

import numpy as np
import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.static_torque import StaticTorque, constant_slip_torque
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

THESIS = load_scenario('thesis')
LOADED = load_scenario(
    'thesis', ['engine.torque_n_m=[150.0, 300.0]', 'driveline.engine_damping=0.05']
)


def slopes_at_start(scenario: Scenario, architecture: str, wear_gain: float = 1.0) -> np.ndarray:
    """Return d/dt of w_m, w_p, w_r and theta_sr at t = 0."""
    start = initial_state(
        RunSettings(KnownSettings(scenario, architecture), CaseSettings(wear_gain=wear_gain))
    )
    model = driveline_matrices(scenario.driveline)
    state = start.states
    torques = [start.engine_torque, start.sides[0].torque, start.load_torque]
    return model.a @ np.array(state) + model.b @ np.array(torques)


def test_thesis_does_not_start_in_equilibrium():
    engine, shaft, *_ = slopes_at_start(THESIS, 'detailed')
    assert engine == pytest.approx(-3.3, abs=0.1)
    assert shaft == pytest.approx(-778.9, abs=0.1)


def test_full_equilibrium_starts_with_constant_slip_and_twist():
    engine, shaft, wheel, twist = slopes_at_start(replace(LOADED, equilibrium='full'), 'detailed')
    assert engine > 10.0
    assert shaft == pytest.approx(engine, rel=1e-9)
    assert wheel * LOADED.driveline.gear.total_ratio == pytest.approx(engine, rel=1e-9)
    assert twist == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize('architecture', ARCHITECTURES)
@pytest.mark.parametrize('wear_gain', [0.7, 1.3])
def test_full_equilibrium_has_no_jolt_in_the_driveshaft_whatever_the_clutch(
    architecture, wear_gain
):
    scenario = replace(LOADED, equilibrium='full')
    _, shaft, wheel, _ = slopes_at_start(scenario, architecture, wear_gain)
    assert shaft == pytest.approx(wheel * LOADED.driveline.gear.total_ratio, rel=1e-9)


def test_thesis_keeps_its_formula_whatever_the_speeds():
    static = StaticTorque(LOADED.driveline, 'thesis')
    formula = constant_slip_torque(LOADED.driveline, 150.0, 60.0)
    assert static.torque(150.0, 60.0, 200.0, 150.0) == formula
    assert THESIS.equilibrium == 'thesis'


def test_unknown_equilibrium_is_refused_by_name():
    with refused(ParameterError, key='equilibrium'):
        load_scenario('thesis', ['equilibrium=half'])
