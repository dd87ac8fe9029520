# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A predictive controller keeps its limits, and reports and counts every failed solution."""

import math
from dataclasses import replace

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import PREVIEW, TABLE_4_1
from ddct_controllers.mpc.estimate.observer import AtRest, NoiseLevels, Observer, kalman_gain
from ddct_controllers.mpc.estimators import make_observer
from ddct_controllers.mpc.model.transmission_model import transmission_model
from ddct_controllers.mpc.program.settings import InputTerms
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.units import rad_s_from_rpm, rpm_from_rad_s
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

RUN = RunSettings(KnownSettings(load_scenario('thesis')))
MODEL = transmission_model(RUN.scenario.driveline)
MPC3 = PREVIEW.settings()


def controller(settings=MPC3):
    return MpcController(MODEL, make_observer(RUN.known, MODEL), settings)


def measurement(step, slip=60.0, open_loop=250.0, reference=None, preview=22):
    coming = [slip - 1.1 * i for i in range(preview + 1)] if reference is None else reference
    return Measurement(
        step,
        210.0,
        210.0 - slip,
        17.0,
        5.4,
        300.0,
        coming,
        [-110.0] * len(coming),
        60.0,
        open_loop,
    )


def answers(mpc, steps=8, **changes):
    mpc.hold(measurement(59, **changes))
    return [mpc.update(measurement(60 + i, slip=60.0 - i, **changes)) for i in range(steps)]


def test_table_4_1_is_as_printed():
    rows = {
        name: (row.prediction_steps, row.control_steps, row.output_weight, row.move_weight)
        for name, row in TABLE_4_1.items()
    }
    assert rows == {
        'mpc1': (12, 3, 0.26, 0.39),
        'mpc2': (16, 6, 0.26, 0.39),
        'mpc3': (22, 4, 0.26, 0.39),
    }
    assert rad_s_from_rpm(MPC3.outputs[0].weight) == pytest.approx(0.26)


def test_without_active_limits_it_is_the_least_squares_solution():
    """The first move is that of the least squares over the simulated step responses."""
    mpc = controller(replace(MPC3, inputs=(replace(MPC3.inputs[0], lowest=-math.inf),)))
    first = measurement(60)
    state = make_observer(RUN.known, MODEL).correct((210.0, 150.0, 17.0), 60.0)
    responses, free = np.zeros((22, 4)), np.zeros(22)
    for j in range(4):
        x = np.zeros(9)
        for i in range(22):
            x = MODEL.a @ x + MODEL.b[:, 0] * (i >= j)
            responses[i, j] = x[0] - x[1]
    x = state
    for i in range(22):
        x = MODEL.a @ x + MODEL.b @ [250.0, 300.0, 60.0]
        free[i] = x[0] - x[1]
    weight = MPC3.outputs[0].weight
    stacked = np.vstack([weight * responses, 0.39 * np.eye(4)])
    wanted = np.concatenate([weight * (first.slip_reference[1:] - free), np.zeros(4)])
    moves = np.linalg.lstsq(stacked, wanted, rcond=None)[0]
    assert mpc.update(first).clutch_torque == pytest.approx(moves[0], rel=1e-6)


def test_final_and_torque_weights_are_in_the_least_squares():
    """P weights the error at the end of the horizon, R the request less the open-loop C_fOL."""
    row = replace(PREVIEW, final_weight=2.0, move_weight=0.1, torque_weight=0.3)
    settings = row.settings()
    free = replace(settings.inputs[0], lowest=-math.inf)
    mpc = controller(replace(settings, inputs=(free,)))
    own = mpc.update(measurement(60)).clutch_torque
    # In the second step the controller has a torque of its own.
    observer = make_observer(RUN.known, MODEL)
    observer.correct((210.0, 150.0, 17.0), 60.0)
    observer.predict((250.0 + own, 300.0, 60.0))
    state = observer.correct((210.0, 149.0, 17.0), 60.0)
    second = measurement(61, slip=61.0)
    responses, held = np.zeros((22, 4)), np.zeros(22)
    for j in range(4):
        x = np.zeros(9)
        for i in range(22):
            x = MODEL.a @ x + MODEL.b[:, 0] * (i >= j)
            responses[i, j] = x[0] - x[1]
    x = state
    for i in range(22):
        x = MODEL.a @ x + MODEL.b @ [250.0 + own, 300.0, 60.0]
        held[i] = x[0] - x[1]
    errors = rpm_from_rad_s(1.0) * (second.slip_reference[1:] - held)
    responses = rpm_from_rad_s(1.0) * responses
    stacked = np.vstack([0.26 * responses, 2.0 * responses[-1:], 0.1 * np.eye(4), 0.3 * np.tri(4)])
    wanted = np.concatenate(
        [0.26 * errors, 2.0 * errors[-1:], np.zeros(4), np.full(4, -0.3 * own)]
    )
    moves = np.linalg.lstsq(stacked, wanted, rcond=None)[0]
    assert mpc.update(second).clutch_torque == pytest.approx(own + moves[0], rel=1e-6)


def test_held_reference_is_its_present_value():
    mpc = controller(replace(MPC3, preview=False))
    assert mpc.preview_steps == 0
    constant = controller().update(measurement(60, reference=[55.0] * 23)).clutch_torque
    assert mpc.update(measurement(60, reference=[55.0])).clutch_torque == constant


@pytest.mark.parametrize('backend', ['daqp', 'osqp'])
def test_request_keeps_its_limits(backend):
    limits = InputTerms(0.39, lowest=0.0, highest=258.0, rate_n_m_s=300.0)
    mpc = controller(replace(MPC3, inputs=(limits,), backend=backend))
    far = [0.0] * 23
    requests = [250.0] + [250.0 + each.clutch_torque for each in answers(mpc, reference=far)]
    assert max(requests) == pytest.approx(258.0, abs=1e-3)
    assert max(np.abs(np.diff(requests))) == pytest.approx(3.0, abs=1e-3)
    down = controller(replace(MPC3, inputs=(limits,), backend=backend))
    high = [400.0] * 23
    requests = [
        20.0 + each.clutch_torque for each in answers(down, open_loop=20.0, reference=high)
    ]
    assert min(requests) == pytest.approx(0.0, abs=1e-3)


def test_rate_limit_counts_what_the_open_loop_moves():
    mpc = controller(replace(MPC3, inputs=(InputTerms(0.39, rate_n_m_s=300.0),)))
    mpc.hold(measurement(59, open_loop=250.0))
    answer = mpc.update(measurement(60, open_loop=230.0, reference=[60.0] * 23))
    assert 230.0 + answer.clutch_torque >= 250.0 - 3.0 - 1e-6


@pytest.mark.parametrize('backend', ['daqp', 'osqp'])
def test_the_rate_goes_before_levels_that_it_cannot_keep(backend):
    """From 250 N m a limit of 230 N m is reached at 300 N m/s, after seven periods."""
    limits = InputTerms(0.39, highest=230.0, rate_n_m_s=300.0)
    mpc = controller(replace(MPC3, inputs=(limits,), backend=backend))
    given = answers(mpc, reference=[0.0] * 23)
    requests = [250.0 + each.clutch_torque for each in given]
    expected = [247.0, 244.0, 241.0, 238.0, 235.0, 232.0, 230.0, 230.0]
    assert requests == pytest.approx(expected, abs=1e-4)
    assert {dict(each.status)['qp_status'] for each in given} == {'solved'}


def test_the_lowest_torque_gives_way_to_the_rate_too():
    limits = InputTerms(0.39, lowest=260.0, rate_n_m_s=300.0)
    mpc = controller(replace(MPC3, inputs=(limits,)))
    given = answers(mpc, steps=5, reference=[400.0] * 23)
    requests = [250.0 + each.clutch_torque for each in given]
    assert requests == pytest.approx([253.0, 256.0, 259.0, 260.0, 260.0], abs=1e-6)
    assert mpc.fallbacks == 0


def test_limits_that_agree_are_the_programs_own():
    mpc = controller(replace(MPC3, inputs=(InputTerms(0.39, highest=258.0, rate_n_m_s=300.0),)))
    assert mpc.clutch.bounds(258.0) == (mpc.program.lower, mpc.program.upper)
    assert mpc.clutch.bounds(258.0)[1] is mpc.program.upper
    assert mpc.clutch.bounds(263.0)[1][:4] == pytest.approx([260.0] + [258.0] * 3)


@pytest.mark.parametrize('held', [True, False])
def test_the_rate_counts_from_the_request_that_the_actuator_received(held):
    """The actuator cuts the request off at 0, however negative the open-loop torque is."""
    mpc = controller(replace(MPC3, inputs=(InputTerms(0.39, rate_n_m_s=300.0),)))
    if held:
        mpc.hold(measurement(59, open_loop=-80.0))
    answer = mpc.update(measurement(60, open_loop=-80.0, reference=[0.0] * 23))
    assert -80.0 + answer.clutch_torque == pytest.approx(3.0, abs=1e-6)
    assert dict(answer.status)['qp_status'] == 'solved'


def test_status_is_deterministic_and_has_the_result_of_the_solver():
    first, again = answers(controller()), answers(controller())
    assert first == again
    status = dict(first[-1].status)
    assert status['qp_status'] == 'solved'
    assert status['fallbacks'] == '0'
    assert int(status['qp_iterations']) >= 1


def test_a_solver_that_gives_up_is_counted_and_the_last_plan_goes_on():
    limits = InputTerms(0.39, highest=252.0, rate_n_m_s=300.0)
    mpc = controller(replace(MPC3, inputs=(limits,)))
    requests = [250.0 + each.clutch_torque for each in answers(mpc, steps=2)]
    planned = mpc._plan.copy()
    mpc.solver = _AlwaysFails()
    answer = mpc.update(measurement(62, slip=58.0))
    status = dict(answer.status)
    assert (status['qp_status'], status['fallbacks']) == ('iteration limit', '1')
    expected = min(max(requests[-1] + planned[1], 0.0), 252.0)
    assert 250.0 + answer.clutch_torque == pytest.approx(expected)
    for step in range(63, 70):
        answer = mpc.update(measurement(step, slip=57.0))
    assert dict(answer.status)['fallbacks'] == '8'
    assert 250.0 + answer.clutch_torque <= 252.0


def test_a_plan_that_is_followed_keeps_the_rate_before_the_level():
    limits = InputTerms(0.39, highest=230.0, rate_n_m_s=300.0)
    mpc = controller(replace(MPC3, inputs=(limits,)))
    mpc.solver = _AlwaysFails()
    requests = [250.0 + each.clutch_torque for each in answers(mpc)]
    expected = [247.0, 244.0, 241.0, 238.0, 235.0, 232.0, 230.0, 230.0]
    assert requests == pytest.approx(expected)


def test_a_reset_controller_has_no_plan_to_follow():
    mpc = controller()
    answers(mpc)
    mpc.reset()
    mpc.solver = _AlwaysFails()
    assert mpc.update(measurement(60)).clutch_torque == 0.0


class _AlwaysFails:
    """Solver that ends every call at its iteration limit."""

    def solve(self, f, lower, upper):
        from ddct_controllers.mpc.qp.problem import QpSolution

        return QpSolution(np.full(len(f), math.nan), 200, 'iteration limit')

    def reset(self):
        pass


def test_plan_is_followed_move_by_move_and_then_held():
    free = replace(MPC3, inputs=(replace(MPC3.inputs[0], lowest=-math.inf),))
    mpc = controller(free)
    before = answers(mpc, steps=2)[-1].clutch_torque
    planned = mpc._plan.copy()
    assert np.abs(np.diff(planned)).min() > 0.1, 'no two moves are the same'
    mpc.solver = _AlwaysFails()
    given = [mpc.update(measurement(62 + i, slip=58.0)).clutch_torque for i in range(6)]
    moves = [*planned[1:], 0.0, 0.0, 0.0]
    assert np.diff([before, *given]) == pytest.approx(moves, abs=1e-9)


class _RecordingObserver(Observer):
    """Observer that stores the inputs of its predictions."""

    def __init__(self):
        start = AtRest(RUN.scenario.driveline.halfshaft_stiffness, initial_request=0.0)
        super().__init__(MODEL, kalman_gain(MODEL, NoiseLevels()), start)
        self.inputs = []

    def predict(self, inputs):
        self.inputs.append(inputs)
        super().predict(inputs)


@pytest.mark.parametrize('held', [True, False])
def test_the_observer_predicts_with_the_request_as_the_actuator_cuts_it_off(held):
    """A request below 0 counts as 0 for the observer, with feedback on or held off."""
    free = replace(MPC3, inputs=(replace(MPC3.inputs[0], lowest=-math.inf),))
    observer = _RecordingObserver()
    mpc = MpcController(MODEL, observer, free)
    now = measurement(60, open_loop=-80.0, reference=[400.0] * 23)
    if held:
        mpc.hold(now)
    else:
        assert now.open_loop_torque + mpc.update(now).clutch_torque < -1.0
    assert observer.inputs == [(0.0, 300.0, 60.0)]
    mpc.hold(measurement(61, open_loop=20.0))
    assert observer.inputs[-1] == (20.0, 300.0, 60.0)


def test_a_level_that_gives_way_leaves_room_for_rounding():
    """The room is larger than the rounding of a torque and too small to measure."""
    limits = InputTerms(0.39, lowest=100.0, highest=230.0, rate_n_m_s=300.0)
    mpc = controller(replace(MPC3, inputs=(limits,)))
    reach = 3.0 * np.arange(1, 5)
    for last in np.random.default_rng(4).uniform(234.0, 1e4, 50):
        room = mpc.clutch.bounds(last)[1][:4] - np.maximum(last - reach, 230.0)
        given_way = last - reach > 230.0
        assert np.all(room[given_way] > 100.0 * np.spacing(last))
        assert np.all(room < 1e-5 * (last / 1e4 + 0.01))
    for last in np.random.default_rng(5).uniform(-1e4, 96.0, 50):
        room = np.minimum(last + reach, 100.0) - mpc.clutch.bounds(last)[0][:4]
        given_way = last + reach < 100.0
        assert np.all(room[given_way] > 100.0 * np.spacing(abs(last)))


def test_soft_limits_are_divided_as_the_outputs_are():
    """K_usura divides the soft limits; the hard ones limit the request and stay as they are."""
    mpc = PREDICTIVE['mpc3'](ControllerContext(RUN.known, {'lowest_slip_rpm': 600.0}))
    lower, upper = mpc.clutch.bounds(250.0, divisor=0.8)
    soft = mpc.program.structure.soft_rows
    assert lower[soft] == pytest.approx([rad_s_from_rpm(750.0)] * 22)
    hard = np.setdiff1d(np.arange(len(lower)), soft)
    assert np.array_equal(lower[hard], mpc.program.lower[hard])
    assert np.array_equal(upper, mpc.program.upper)


def test_every_request_that_the_rate_can_just_bring_within_its_level_is_found():
    """From one step of the rate above the limit on, rounding decides whether the bounds cross."""
    limits = InputTerms(0.39, highest=230.0, rate_n_m_s=300.0)
    for last in 233.0 + np.concatenate([[0.0], np.random.default_rng(6).uniform(0.0, 90.0, 60)]):
        mpc = controller(replace(MPC3, inputs=(limits,)))
        mpc.hold(measurement(59, open_loop=last))
        answer = mpc.update(measurement(60, open_loop=last, reference=[0.0] * 23))
        assert dict(answer.status)['qp_status'] == 'solved', last
        assert answer.clutch_torque == pytest.approx(-3.0, abs=1e-5)


def test_an_iteration_limit_that_is_too_low_falls_back_for_real():
    limits = InputTerms(0.39, lowest=0.0, highest=251.0, rate_n_m_s=50.0)
    mpc = controller(replace(MPC3, inputs=(limits,), iteration_limit=1))
    fallen = [int(dict(each.status)['fallbacks']) for each in answers(mpc, reference=[0.0] * 23)]
    assert fallen[-1] > 0
    assert all(0.0 <= 250.0 + each.clutch_torque <= 251.0 for each in answers(mpc))


@pytest.mark.parametrize('backend', ['daqp', 'osqp'])
def test_a_reset_controller_is_a_new_one(backend):
    used = controller(replace(MPC3, backend=backend))
    answers(used, open_loop=180.0)
    used.reset()
    fresh = controller(replace(MPC3, backend=backend))
    assert answers(used) == answers(fresh)


@pytest.mark.parametrize(
    ('options', 'key'),
    [
        ({'horizon': 3}, 'controllers.mpc3.horizon'),
        ({'prediction_steps': 3}, 'MPC: control_steps'),
        ({'prediction_steps': 1.5}, 'controllers.mpc3.prediction_steps'),
        ({'control_steps': 0}, 'controllers.mpc3.control_steps'),
        ({'preview': 1}, 'controllers.mpc3.preview'),
        ({'backend': 'magic'}, 'controllers.mpc3.backend'),
        ({'highest_torque_n_m': 0.0}, 'controllers.mpc3.highest_torque_n_m'),
        ({'torque_rate_n_m_s': -1.0}, 'controllers.mpc3.torque_rate_n_m_s'),
        ({'torque_rate_n_m_s': -5.0}, 'controllers.mpc3.torque_rate_n_m_s'),
        ({'torque_rate_n_m_s': 1e300}, 'controllers.mpc3.torque_rate_n_m_s'),
        ({'iteration_limit': math.nan}, 'controllers.mpc3.iteration_limit'),
        ({'iteration_limit': 1e300}, 'controllers.mpc3.iteration_limit'),
        ({'iteration_limit': 2**40}, 'controllers.mpc3.iteration_limit'),
        ({'prediction_steps': 1e6}, 'controllers.mpc3.prediction_steps'),
        (
            {'prediction_steps': 1, 'control_steps': 1, 'delay_in_model': True},
            'MPC: prediction_steps',
        ),
        ({'measured': 'speed'}, 'controllers.mpc3.measured'),
        ({'load_known': 'no'}, 'controllers.mpc3.load_known'),
        ({'delay_in_model': 0}, 'controllers.mpc3.delay_in_model'),
        ({'output_weight': -0.1}, 'controllers.mpc3.output_weight'),
        ({'final_weight': math.inf}, 'controllers.mpc3.final_weight'),
        ({'move_weight': 'R'}, 'controllers.mpc3.move_weight'),
        (
            {'torque_weight': 1e7},
            'controllers.mpc3.torque_weight',
        ),
        ({'output_weight': 0.0, 'move_weight': 0.0}, 'variable 0'),
        ({'lowest_slip_rpm': 'none'}, 'controllers.mpc3.lowest_slip_rpm'),
        ({'lowest_slip_rpm': 1e7}, 'controllers.mpc3.lowest_slip_rpm'),
        ({5: 7, 'horizon': 3}, 'controllers.mpc3.5'),
    ],
)
def test_bad_options_are_named(options, key):
    with refused(ParameterError, key=key):
        PREDICTIVE['mpc3'](ControllerContext(RUN.known, options))


def test_options_reach_the_program():
    options = {
        'prediction_steps': 9,
        'control_steps': 2,
        'torque_rate_n_m_s': 100.0,
        'preview': True,
    }
    mpc = PREDICTIVE['mpc1'](ControllerContext(RUN.known, options))
    assert mpc.preview_steps == 9
    requests = [250.0] + [250.0 + a.clutch_torque for a in answers(mpc, reference=[0.0] * 10)]
    assert max(np.abs(np.diff(requests))) == pytest.approx(1.0)


def test_the_lowest_slip_is_soft_and_holds_where_it_can():
    """At a slip of 60 rad/s all 22 periods have a soft row, and the program is solved."""
    free, limited = (
        PREDICTIVE['mpc3'](ControllerContext(RUN.known, options))
        for options in ({}, {'lowest_slip_rpm': 600.0})
    )
    assert limited.program.structure.soft_rows.tolist() == list(range(4, 26))
    assert limited.program.lower[4:] == pytest.approx([rad_s_from_rpm(600.0)] * 22)
    given = [answers(mpc, steps=1, reference=[0.0] * 23)[0] for mpc in (free, limited)]
    assert given[1].clutch_torque < given[0].clutch_torque - 1.0
    assert dict(given[1].status)['qp_status'] == 'solved'


def test_a_second_input_is_refused():
    with refused(ParameterError, 'inputs'):
        controller(replace(MPC3, inputs=(InputTerms(0.1), InputTerms(0.1))))


class NoSolution:
    """Solver that reports its iteration limit at chosen calls."""

    def __init__(self, solver, at):
        self.solver, self._at, self._calls = solver, at, 0

    def reset(self):
        self.solver.reset()

    def solve(self, *program):
        self._calls += 1
        solution = self.solver.solve(*program)
        return replace(solution, status='iteration limit') if self._calls in self._at else solution


def test_the_status_counts_the_steps_without_a_solution():
    mpc = controller()
    mpc.solver = NoSolution(mpc.solver, at=(3, 4, 7))
    statuses = [dict(each.status) for each in answers(mpc)]
    assert [status['fallbacks'] for status in statuses] == list('00122233')
    assert [status['qp_status'] == 'solved' for status in statuses].count(False) == 3
    mpc.reset()
    assert dict(answers(mpc, steps=1)[0].status)['fallbacks'] == '0'
