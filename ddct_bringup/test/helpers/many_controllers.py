# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers of many runs beside each of them step by step, on recorded signals."""

import numpy as np
from step_by_step import batch_of, step_by_step

from ddct_bringup.batch.batchable import kind_of, why_not_batchable
from ddct_bringup.batch.controllers.interface import Measured
from ddct_controllers.interface import Measurement
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings

RUNS, STEPS, START = 200, 40, 10


def known(mass=1500.0, scenario='launch'):
    return KnownSettings(load_scenario(scenario, {'vehicle.mass_kg': mass}))


def recorded_engagements():
    """Return noisy signals of engagements that are followed badly: 200 runs, 40 steps."""
    random = np.random.default_rng(53)
    step, ahead = np.arange(STEPS)[:, np.newaxis], np.arange(23)

    def noise(size):
        return random.normal(scale=size, size=(STEPS, RUNS))

    start = random.uniform(5.0, 60.0, RUNS)
    since = np.maximum(step[..., np.newaxis] + ahead - START, 0)
    references = np.maximum(start[:, np.newaxis] - 1.1 * since, 0.0)
    rates = np.where((references > 0.0) & (since > 0), -110.0, 0.0)
    slip = references[..., 0] + noise(0.3) + random.normal(scale=3.0, size=RUNS)
    shaft = random.uniform(20.0, 190.0, RUNS) + 0.3 * step
    torque, load = random.uniform(20.0, 300.0, RUNS) + noise(1.0), 60.0 + noise(5.0)
    on = np.repeat(step >= START, RUNS, axis=1)
    on[30:34, ::3] = False
    speeds = shaft + slip, shaft, shaft / 16.06 + noise(0.01), shaft / 50.0
    signals = (*speeds, torque, references, rates, load, 0.9 * torque - 20.0, on)
    return [Measured(at, *(each[at] for each in signals)) for at in range(STEPS)]


def part(measured, preview_steps, runs=slice(None)):
    """Return the signals of some runs with these preview steps."""
    points = slice(0, preview_steps + 1)
    values = [each[runs] for each in measured[1:]]
    values[5], values[6] = values[5][:, points], values[6][:, points]
    return Measured(measured.step, *values)


def stacked_torques(controllers, recorded, runs=slice(None)):
    stack = kind_of(controllers[0]).of(controllers, [known()] * len(controllers))
    steps = controllers[0].preview_steps
    return np.array([stack.update(part(each, steps, runs)) for each in recorded])


def single_torques(controller, recorded, run):
    """Return the torques step by step and the last status."""
    controller.reset()
    torques, status = [], ()
    for each in recorded:
        *values, on = (value[run].tolist() for value in part(each, controller.preview_steps)[1:])
        measurement = Measurement(each.step, *values)
        if on:
            command = controller.update(measurement)
            status = command.status
        else:
            controller.hold(measurement)
        torques.append(command.clutch_torque if on else 0.0)
    return np.array(torques), dict(status)


def assert_step_by_step(runs):
    """
    Assert that the batch of (settings, controller) is that of each run step by step.

    Every value is within 1e-9 of the peak of its signal, and every state and count the same.
    """
    assert {why_not_batchable(*run) for run in runs} == {''}
    for run, (ours, signals) in zip(runs, batch_of(runs), strict=True):
        expected, single = step_by_step(*run)
        assert ours is not None and signals is not None
        assert (ours.valid, ours.state, ours.why) == (True, expected.state, expected.why)
        assert ours.fallbacks == expected.fallbacks
        for signal, found in signals.items():
            theirs = getattr(single, signal)
            theirs = theirs[:, :1] if signal == 'slip_reference' else theirs
            if found.dtype == object:
                assert [len(events) for events in found] == [len(events) for events in theirs]
                continue
            largest = 1e-9 * np.abs(theirs).max()
            # Not by `pytest.approx`, which takes 7 us for each value.
            np.testing.assert_allclose(
                found, theirs, rtol=0.0, atol=largest, equal_nan=False, err_msg=signal
            )
