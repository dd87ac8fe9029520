# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names of states, inputs and outputs, and models that give the index of each."""

import numpy as np
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.names import Names
from ddct_plant.models.driveline_model import (
    OUTPUTS,
    STATES,
    STATES_AND_ANGLES,
    TORQUES,
    driveline_matrices,
    matrices_with_angles,
)
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.settings import KnownSettings, RunSettings

PARAMETERS = DrivelineParameters()


def test_names_give_indices_and_slices_and_can_be_joined() -> None:
    names = Names(('speed', 'twist')) + Names(('heat',))
    assert (len(names), list(names)) == (3, ['speed', 'twist', 'heat'])
    assert names['heat'] == 2
    assert names.places('heat', 'speed') == [2, 0]
    assert np.arange(3)[names.column('twist')].tolist() == [1]


def test_an_unknown_or_repeated_name_is_refused() -> None:
    with refused(ParameterError, 'torque'):
        Names(('speed', 'twist'))['torque']
    with refused(ParameterError, 'speed'):
        Names(('speed',)) + Names(('speed',))


def test_the_model_of_the_driveline_names_every_row_and_column() -> None:
    model = driveline_matrices(PARAMETERS)
    assert model.a.shape == (len(model.states), len(model.states))
    assert model.b.shape == (len(model.states), len(model.torques))
    assert model.c.shape == (len(model.outputs), len(model.states))
    a, b = matrices_with_angles(PARAMETERS)
    assert a.shape == (len(STATES_AND_ANGLES), len(STATES_AND_ANGLES))
    for speed, angle in (('engine_speed', 'engine_angle'), ('wheel_speed', 'wheel_angle')):
        assert a[STATES_AND_ANGLES[angle], STATES_AND_ANGLES[speed]] == 1.0
    assert b.shape == (len(STATES_AND_ANGLES), len(TORQUES))


def test_a_path_is_the_response_of_one_output_to_one_torque() -> None:
    model = driveline_matrices(PARAMETERS)
    path = model.path('engine_torque', 'slip_speed')
    assert path.b.tolist() == [[1.0 / PARAMETERS.engine_inertia], [0.0], [0.0], [0.0]]
    assert path.c.tolist() == [model.output('slip_speed').tolist()]
    held = dict(zip(STATES, model.output('torsion_speed').tolist(), strict=True))
    assert held['shaft_speed'] == PARAMETERS.gear.wheel_speed(1.0)
    assert held['wheel_speed'] == -1.0
    assert OUTPUTS['torsion_speed'] == 1


def test_an_initial_state_gives_its_values_in_the_order_of_the_model() -> None:
    start = initial_state(RunSettings(KnownSettings(load_scenario('tip_in'))))
    values = dict(zip(STATES, start.states, strict=True))
    assert values['engine_speed'] == start.engine_speed == 160.0
    assert values['wheel_speed'] == start.wheel_speed
    assert values['twist'] == start.twist > 0.0
