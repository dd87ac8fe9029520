"""A predictive controller keeps its limits, says what it did, and never goes on in silence."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.mpc.build import make_observer
from ddct_controllers.mpc.predictive_controller import PredictiveController
from ddct_controllers.mpc.settings import InputTerms, MpcSettings, OutputTerms
from ddct_controllers.mpc.thesis_mpc import TABLE_4_1, make_thesis_mpc, thesis_settings
from ddct_controllers.mpc.transmission_model import SLIP_SPEED, transmission_model
from ddct_plant.errors import DdctError, ParameterError
from ddct_plant.run_settings import RunSettings
from ddct_plant.scenario_file import load_scenario
from ddct_plant.units import rad_s_from_rpm

RUN = RunSettings(load_scenario('thesis'))
MODEL = transmission_model(RUN.scenario.driveline)
MPC3 = thesis_settings(TABLE_4_1['mpc3'])


def controller(settings=MPC3):
    return PredictiveController(MODEL, make_observer(RUN, MODEL), settings)


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
    """The same first move as the normal equations of the simulated step responses give."""
    mpc = controller(replace(MPC3, inputs=(replace(MPC3.inputs[0], lowest=-math.inf),)))
    first = measurement(60)
    state = make_observer(RUN, MODEL).correct((210.0, 150.0, 17.0), 60.0)
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


def test_status_is_deterministic_and_says_what_the_solver_did():
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
    mpc._solver = _Silent()
    answer = mpc.update(measurement(62, slip=58.0))
    status = dict(answer.status)
    assert (status['qp_status'], status['fallbacks']) == ('iteration limit', '1')
    expected = min(max(requests[-1] + planned[1], 0.0), 252.0)
    assert 250.0 + answer.clutch_torque == pytest.approx(expected)
    for step in range(63, 70):
        answer = mpc.update(measurement(step, slip=57.0))
    assert dict(answer.status)['fallbacks'] == '8'
    assert 250.0 + answer.clutch_torque <= 252.0


class _Silent:
    """A solver that never gets there."""

    def solve(self, f, lower, upper):
        from ddct_controllers.mpc.qp.solution import QpSolution

        return QpSolution(np.full(len(f), math.nan), 200, 'iteration limit', math.nan)

    def reset(self):
        pass


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


def test_measurements_that_are_not_finite_are_refused():
    mpc = controller()
    with pytest.raises(DdctError, match='at step 60: mend what measures them'):
        mpc.update(measurement(60, slip=math.nan, reference=[0.0] * 23))


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        ({'horizon': 3}, r'controllers\.mpc3\.horizon is not a key of mpc3'),
        ({'prediction_steps': 3}, 'control_steps is 4, longer than prediction_steps, 3'),
        ({'prediction_steps': 1.5}, 'give a whole number'),
        ({'control_steps': 0}, r'controllers\.mpc3\.control_steps'),
        ({'preview': 1}, 'give true or false'),
        ({'backend': 'magic'}, r'unknown controllers\.mpc3\.backend'),
        ({'highest_torque_n_m': 0.0}, r'controllers\.mpc3\.highest_torque_n_m'),
        ({'torque_rate_n_m_s': -1.0}, r'controllers\.mpc3\.torque_rate_n_m_s'),
        ({'iteration_limit': math.nan}, r'controllers\.mpc3\.iteration_limit'),
    ],
)
def test_bad_options_are_named(options, complaint):
    with pytest.raises(ParameterError, match=complaint):
        make_thesis_mpc('mpc3', ControllerContext(RUN, options))


def test_options_reach_the_program():
    options = {'prediction_steps': 9, 'control_steps': 2, 'torque_rate_n_m_s': 100.0}
    mpc = make_thesis_mpc('mpc1', ControllerContext(RUN, options))
    assert mpc.preview_steps == 9
    requests = [250.0] + [250.0 + a.clutch_torque for a in answers(mpc, reference=[0.0] * 10)]
    assert max(np.abs(np.diff(requests))) == pytest.approx(1.0)


def test_two_inputs_ask_the_engine_too():
    settings = MpcSettings(
        7,
        1,
        (OutputTerms(SLIP_SPEED, 1.0),),
        (InputTerms(move_weight=0.1), InputTerms(move_weight=0.1, target_weight=0.1)),
    )
    mpc = controller(settings)
    assert mpc.commands_engine
    assert all(each.engine_torque is not None for each in answers(mpc, preview=7))
