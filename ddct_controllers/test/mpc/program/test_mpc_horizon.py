# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The condensed program is the cost and the limits that the settings state, nothing else."""

import math
from dataclasses import replace

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    SLIP_ACCELERATION,
    SLIP_SPEED,
    TORSION_SPEED,
    transmission_model,
)
from ddct_controllers.mpc.program.horizon import condense, predict
from ddct_controllers.mpc.program.settings import InputTerms, MpcSettings, OutputTerms
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.parameters import DrivelineParameters

MODEL = transmission_model(DrivelineParameters())
ONE = MpcSettings(
    (OutputTerms(SLIP_SPEED, 2.0), OutputTerms(TORSION_SPEED, 5.0)), (InputTerms(0.4),), 9, 3
)
TWO = MpcSettings(
    (OutputTerms(SLIP_SPEED, 1.0), OutputTerms(SLIP_ACCELERATION, 0.05)),
    (InputTerms(move_weight=0.1), InputTerms(move_weight=0.2, target_weight=0.3)),
    7,
    2,
)
RANDOM = np.random.default_rng(2)
STATE = np.array([180.0, 150.0, 16.0, 0.01, *RANDOM.normal(size=4), 40.0])


def simulate(settings, before, known, moves):
    """Return weighted outputs (p, outputs) and inputs (m, inputs) by running the model."""
    inputs = len(settings.inputs)
    levels = before + np.cumsum(moves.reshape(settings.control_steps, inputs), axis=0)
    rows = [terms.output for terms in settings.outputs]
    state, outputs = STATE, []
    for i in range(settings.prediction_steps + 1):
        u = np.zeros(3)
        u[:inputs] = levels[min(i, settings.control_steps - 1)]
        u[inputs:] = known
        if i > 0:
            outputs.append((MODEL.c @ state + MODEL.d @ u)[rows])
        state = MODEL.a @ state + MODEL.b @ u
    return np.array(outputs), levels


def case(settings):
    inputs = len(settings.inputs)
    before = np.array([35.0, 120.0])[:inputs]
    known = np.array([110.0, 60.0])[inputs - 1 :]
    moves = RANDOM.normal(size=inputs * settings.control_steps)
    targets = np.array([0.0, 140.0])[:inputs]
    references = RANDOM.normal(size=(settings.prediction_steps, len(settings.outputs)))
    return before, known, moves, targets, references


@pytest.mark.parametrize('settings', [ONE, TWO], ids=['one input', 'two inputs'])
def test_prediction_is_the_simulated_model(settings):
    before, known, moves, _, _ = case(settings)
    prediction = predict(MODEL, settings)
    v = np.concatenate([STATE, before, known])
    outputs, _ = simulate(settings, before, known, moves)
    predicted = prediction.from_moves @ moves + prediction.from_known @ v
    assert predicted == pytest.approx(outputs.ravel(), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize('settings', [ONE, TWO], ids=['one input', 'two inputs'])
def test_program_is_the_stated_cost(settings):
    """It is half the cost of simulated outputs, moves and levels, up to a constant."""
    before, known, moves, targets, references = case(settings)
    program = condense(MODEL, settings)
    f = program.gradient @ np.concatenate([STATE, before, known, targets, references.ravel()])

    def cost(z):
        outputs, levels = simulate(settings, before, known, z)
        steps = z.reshape(levels.shape)
        total = 0.0
        for column, terms in enumerate(settings.outputs):
            total += np.sum((terms.weight * (outputs - references)[:, column]) ** 2)
        for column, terms in enumerate(settings.inputs):
            total += np.sum((terms.move_weight * steps[:, column]) ** 2)
            total += np.sum((terms.target_weight * (levels[:, column] - targets[column])) ** 2)
        return total / 2.0

    expected = cost(moves) - cost(np.zeros_like(moves))
    assert 0.5 * moves @ program.structure.hessian @ moves + f @ moves == pytest.approx(
        expected, rel=1e-7
    )


def test_rows_are_levels_rates_and_soft_outputs():
    limited = replace(
        TWO,
        outputs=(OutputTerms(SLIP_SPEED, 1.0, lowest=-1.0), TWO.outputs[1]),
        inputs=(
            replace(TWO.inputs[0], lowest=0.0, highest=350.0, rate_n_m_s=2000.0),
            replace(TWO.inputs[1], lowest=-math.inf, highest=300.0),
        ),
    )
    before, known, moves, _, _ = case(limited)
    jump = np.array([3.0, 0.0])
    program = condense(MODEL, limited)
    shift = program.shift @ np.concatenate([STATE, before, known, jump])
    values = program.structure.constraints @ moves + shift
    outputs, levels = simulate(limited, before, known, moves)
    steps = moves.reshape(levels.shape)
    rates = steps[:, 0] + np.array([3.0, 0.0])
    expected = np.concatenate([levels.ravel(), rates, outputs[:, 0]])
    assert values == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert program.lower.tolist() == [0.0, -math.inf] * 2 + [-20.0] * 2 + [-1.0] * 7
    assert program.upper.tolist() == [350.0, 300.0] * 2 + [20.0] * 2 + [math.inf] * 7
    assert program.structure.soft_rows.tolist() == list(range(6, 13))


def test_inputs_without_limits_have_no_rows():
    free = replace(ONE, inputs=(InputTerms(0.4, lowest=-math.inf),))
    assert condense(MODEL, free).structure.constraints.shape == (0, 3)


def test_known_engine_torque_acts_as_in_the_model():
    more = replace(ONE, outputs=(OutputTerms(SLIP_SPEED, 1.0),))
    column = predict(MODEL, more).from_known[:, len(STATE) + 1]
    state = np.zeros(len(STATE))
    for predicted in column:
        state = MODEL.a @ state + MODEL.b[:, ENGINE_TORQUE]
        assert predicted == pytest.approx((MODEL.c @ state)[SLIP_SPEED])


@pytest.mark.parametrize(
    ('change', 'key'),
    [
        ({'prediction_steps': 0}, 'MPC: prediction_steps'),
        ({'prediction_steps': 2.5}, 'MPC: prediction_steps'),
        ({'control_steps': 10}, 'MPC: control_steps'),
        ({'iteration_limit': 0}, 'MPC: iteration_limit'),
        ({'backend': 'magic'}, 'MPC: backend'),
        ({'outputs': ()}, 'MPC'),
        ({'inputs': ()}, 'MPC'),
        ({'soft_limit_weight': 0.0}, 'MPC: soft_limit_weight'),
    ],
)
def test_settings_that_do_not_fit_are_named(change, key):
    with refused(ParameterError, key=key):
        replace(ONE, **change)


@pytest.mark.parametrize(
    ('terms', 'key'),
    [
        (lambda: InputTerms(move_weight=-1.0), 'MPC: move_weight'),
        (lambda: InputTerms(target_weight=math.nan), 'MPC: target_weight'),
        (lambda: InputTerms(highest=0.0), 'MPC: the lowest torque'),
        (lambda: InputTerms(highest=-5.0), 'MPC: the lowest torque'),
        (lambda: InputTerms(rate_n_m_s=0.0), 'MPC: rate_n_m_s'),
        (lambda: InputTerms(rate_n_m_s=math.nan), 'MPC: rate_n_m_s'),
        (lambda: OutputTerms(SLIP_SPEED, -1.0), 'MPC: output weight'),
        (lambda: OutputTerms(SLIP_SPEED, 1.0, lowest=2.0, highest=1.0), 'MPC: the lowest output'),
    ],
)
def test_terms_out_of_range_are_named(terms, key):
    with refused(ParameterError, key=key):
        terms()


def test_level_rows_are_those_of_each_input():
    """The first input has rows for levels and rates, the second for its rate alone."""
    engine = replace(TWO.inputs[1], lowest=-math.inf, rate_n_m_s=500.0)
    clutch = replace(TWO.inputs[0], highest=350.0, rate_n_m_s=2000.0)
    both = condense(MODEL, replace(TWO, inputs=(clutch, replace(engine, highest=300.0))))
    assert [rows.tolist() for rows in both.level_rows] == [[0, 2], [1, 3]]
    assert both.upper[both.level_rows[1]].tolist() == [300.0, 300.0]
    one = condense(MODEL, replace(TWO, inputs=(clutch, engine)))
    assert [rows.tolist() for rows in one.level_rows] == [[0, 1], []]


def test_a_horizon_that_no_move_reaches_is_refused():
    """The request acts from the second period on, C_m within the first."""
    for inputs in (ONE.inputs, TWO.inputs):
        short = replace(TWO, prediction_steps=1, control_steps=1, inputs=inputs)
        with refused(ParameterError, key='MPC: prediction_steps'):
            condense(MODEL, short)
        condense(MODEL, replace(short, prediction_steps=2))


@pytest.mark.parametrize('inputs', [(InputTerms(),), (InputTerms(),) * 2])
def test_moves_that_nothing_weighs_are_refused(inputs):
    """The request's last move acts beyond the horizon."""
    loose = MpcSettings((OutputTerms(SLIP_SPEED, 1.0),), inputs, 3, 3)
    with refused(ParameterError, key='MPC: control_steps'):
        condense(MODEL, loose)
    weighed = tuple(replace(terms, move_weight=0.1) for terms in inputs)
    for fitting in (replace(loose, inputs=weighed), replace(loose, inputs=weighed[:1])):
        assert (np.diag(condense(MODEL, fitting).structure.hessian) > 0.0).all()
    condense(MODEL, replace(loose, inputs=inputs[:1], control_steps=2))


def test_weights_that_leave_the_program_singular_are_refused():
    """With weights on slip alone, C_m and the clutch have the same effect."""
    loose = MpcSettings((OutputTerms(SLIP_SPEED, 1.0),), (InputTerms(), InputTerms()), 60, 20)
    with refused(ParameterError, 'hessian'):
        condense(MODEL, loose)
