# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A batch of gear shifts gives the signals and results of each shift step by step."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from batch_runs import bits_of, some
from samples import sampled
from shifts import SHIFTS

from ddct_bringup.batch.batchable import why_not_batchable
from ddct_controllers.handover.laws import HANDOVERS
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

CONTROLLERS = ('ls8', 'pi', 'ls3', 'hinf1', 'mpc1', 'mpc3', 'mpc_torsion', 'least_jerk')


def gearbox(random):
    """Engage the on-coming gear within the run, and disengage the other one."""
    return {
        'shift.preselection_s': 0.15,
        'shift.free_shaft_rad_s': some(random, 0.0, 200.0),
        'shift.disengagement_s': 0.9,
    }


def sensors(random):
    return {
        'sensors.engine_speed.noise_rad_s': some(random, 0.0, 0.2),
        'sensors.engine_torque.bias_n_m': some(random, -3.0, 3.0),
        'sensors.vehicle_speed.delay_s': 0.01 * int(random.integers(0, 8)),
    }


def engine(random):
    """Let the engine stall at a high speed, and follow a torque cut slowly."""
    return {
        'engine_limits.stall_rad_s': some(random, 180.0, 240.0),
        'engine_limits.idle_most_n_m': 0.0,
        'engine_limits.idle_rad_s': 245.0,
        'engine_authority.slew_n_m_s': some(random, 300.0, 3000.0),
        'engine_authority.lag_s': 0.03,
    }


def clutches(random):
    return {
        'friction.static_over_kinetic': some(random, 1.0, 1.3),
        'friction.kiss_torque_n_m': some(random, 0.0, 5.0),
        'heat.facing_c': some(random, 20.0, 300.0),
        'actuator.delay_s': int(random.integers(0, 35)) / 1000,
        'reference.shape': 'ramp',
    }


PARTS = {
    'plain': lambda random: {},
    **{f.__name__: f for f in (gearbox, sensors, engine, clutches)},
}


def drawn(random, name, handover, part, **further):
    """Return a packaged shift with random values, and a controller."""
    changes = {
        **further,
        'vehicle.mass_kg': some(random, 1200.0, 1800.0),
        'shift.handover_s': 0.01 * int(random.integers(10, 30)),
        'shift.torque_cut_n_m': some(random, 0.0, 40.0),
        **PARTS[part](random),
    }
    settings = RunSettings(
        KnownSettings(load_scenario(name, changes), handover=handover),
        CaseSettings(
            wear_gain=some(random, 0.6, 1.4),
            off_going_wear_gain=some(random, 0.6, 1.4),
            seed=int(random.integers(1000)),
        ),
    )
    return settings, make_controller(str(random.choice(CONTROLLERS)), settings.known)


@pytest.fixture(scope='module', params=sampled([9, 1], every=2))
def every(request):
    """Return the distance of the runs among all shifts, handovers and parts."""
    return request.param


@pytest.fixture(scope='module')
def runs(every):
    random = np.random.default_rng(11)
    drawings = [
        (name, handover, part) for name in SHIFTS for handover in HANDOVERS for part in PARTS
    ]
    return [drawn(random, *each, duration_s=1.8) for each in drawings[::every]]


def assert_same(signals, run):
    """Check the signals of a run against those step by step."""
    for name, values in signals.items():
        expected = getattr(run, name)
        if name.endswith('events'):
            found, wanted = (
                [(step, event.kind) for step, events in enumerate(each) for event in events]
                for each in (values, expected)
            )
            assert found == wanted, name
            continue
        if name == 'slip_reference':  # of a preview the batch has the first value
            expected = expected[:, :1]
        assert np.shape(values) == np.shape(expected), name
        assert np.array_equal(np.isfinite(values), np.isfinite(expected)), name
        finite = np.isfinite(expected)
        if finite.any():
            difference = np.abs(values - expected)[finite].max()
            assert difference <= 1e-9 * np.abs(expected[finite]).max(), name


def test_every_shift_can_be_in_a_batch(runs):
    assert {why_not_batchable(*run) for run in runs} == {''}


def test_signals_and_events_are_those_of_the_run_step_by_step(runs, batch, serial, every):
    ends: Counter[bool] = Counter()
    tie_ups = 0
    for (settings, _), (_, signals), (_, run) in zip(runs, batch, serial, strict=True):
        assert signals is not None
        assert len(signals['slip_speed']) == run.steps + 1
        assert_same(signals, run)
        ends[run.steps < settings.scenario.steps] += 1
        tie_ups += bool(run.tie_up_work.any())
    assert min(ends[True], tie_ups) >= (5 if every == 1 else 1)


def test_results_are_those_of_the_run_step_by_step(batch, serial):
    for (ours, _), (expected, _) in zip(batch, serial, strict=True):
        assert ours is not None
        assert (ours.valid, ours.reason) == (expected.valid, expected.reason)
        assert (ours.state, ours.why) == (expected.state, expected.why)
        for name, value in expected.metrics.items():
            found = ours.metrics[name]
            if value is None or found is None:
                assert found is value, name
            else:
                assert found == pytest.approx(value, rel=1e-9, abs=1e-12), name
        for limit, other in zip(ours.limits, expected.limits, strict=True):
            assert limit == replace(other, value=limit.value)


@pytest.mark.parametrize(
    ('handover', 'most'),
    sampled(
        [('adaptive', 40), ('adaptive', 1000), ('model', 40), ('slip', 40), ('timed', 40)], every=5
    ),
)
def test_a_shift_does_not_depend_on_the_rest_of_the_batch(handover, most):
    random = np.random.default_rng(2)
    controller = make_controller('ls8', KnownSettings(load_scenario('upshift')))
    runs = [
        (drawn(random, 'upshift', handover, 'plain', duration_s=1.5)[0], controller)
        for _ in range(33)
    ]
    bits = bits_of(runs)
    for size in (1, 2, 3, most):
        places = [place % 33 for place in range(size)]
        assert bits_of([runs[place] for place in places]) == [bits[place] for place in places]
    assert bits_of(runs[::-1]) == bits[::-1]


def test_a_handover_of_a_third_party_goes_step_by_step(tmp_path):
    file = tmp_path / 'mine.py'
    file.write_text('')
    settings = RunSettings(KnownSettings(load_scenario('upshift'), handover=str(file)))
    controller = make_controller('ls8', settings.known)
    reason = why_not_batchable(settings, controller)
    assert reason == 'the handover is mine, code of a third party'
