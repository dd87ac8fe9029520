# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The metrics of many runs at once are those of each single run, for any slip."""

from typing import Any

import numpy as np
import pytest

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.results import part_of_stack, stacked_plants
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.limited import judder
from ddct_bringup.metrics.metric import finite
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.values import raw_metrics
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_plant.models.clutch import FrictionParameters
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters

EXACT = ('friction_work_over_least', 'mean_acceleration_m_s2', 'mean_negative_jerk_m_s3')
RUNS, SAMPLES, START, WINDOW = 40, 431, 200, (200, 300)
PLANTS = [
    JudgedPlant.of_parameters(
        DrivelineParameters(engine_inertia=0.1 + 0.01 * run),
        VehicleParameters(),
        FrictionParameters(),
    )
    for run in range(RUNS)
]


@pytest.fixture(scope='module')
def stack():
    """Return random-walk signals, with slips that are zero at times, or that never reach zero."""
    random = np.random.default_rng(3)

    def wandering(*shape):
        return np.cumsum(random.normal(size=(RUNS, SAMPLES, *shape)), axis=1)

    slip = 20.0 + wandering() * random.uniform(0.1, 3.0, (RUNS, 1))
    for run in range(RUNS):
        for first in random.integers(0, START, run % 4):
            slip[run, first : first + 5] = 0.0
    slip[0] = 0.0
    return Trajectory(
        {
            'joint_speed': wandering(4),
            'joint_effort': wandering(4),
            'slip_speed': slip,
            'vehicle_accel': wandering(),
            'slip_reference': wandering(1),
            'torque_request': wandering(),
            'torque_demand': np.maximum(
                wandering(), np.where(np.arange(RUNS) % 2, 0.0, -9.0)[:, None]
            ),
            'engine_torque': wandering(),
        }
    )


def judged(trajectory, window=WINDOW, plant=None):
    return Engagement(trajectory, START, window, SAMPLES - 1, plant, RunTiming())


@pytest.mark.parametrize('window', [WINDOW, (200, 500)], ids=['scored', 'ends before'])
def test_metrics_are_those_of_each_single_run(stack, window):
    ours: dict[str, Any] = raw_metrics(judged(stack, window, stacked_plants(PLANTS)))
    undefined = set()
    for run in range(RUNS):
        single = raw_metrics(judged(part_of_stack(stack, run), window, PLANTS[run]))
        for name, value in single.items():
            found = ours[name] if np.ndim(ours[name]) == 0 else ours[name][run]
            if finite(value) is None:
                undefined.add(name)
                assert finite(found) is None, name
            else:
                assert found == pytest.approx(value, rel=0.0 if name in EXACT else 1e-12), name
    assert {'judder_rpm', 'engagement_time_s', 'torque_late_s'} <= undefined


def test_judder_begins_at_half_a_second_of_slipping_in_a_batch_as_in_a_single_run(stack):
    """Judder exists from 51 samples on, for 100 and 101 samples; the last run starts at rest."""
    lengths = [1, 15, 16, 50, 51, 100, 101, 0]
    steps = np.arange(SAMPLES)
    slip = np.array([np.where(steps < START + length, 30.0, -1e-9) for length in lengths])
    slip[-1] = np.where((steps >= START + 5) & (steps < START + 125), 30.0, 0.0)
    signals = part_of_stack(stack, slice(len(lengths))).signals
    trajectory = Trajectory({**signals, 'slip_speed': slip})
    batch: Any = judder(judged(trajectory))
    single = [finite(judder(judged(part_of_stack(trajectory, run)))) for run in range(len(slip))]
    assert [each is not None for each in single] == [length >= 51 for length in lengths[:-1]] + [
        True
    ]
    assert [finite(each) for each in batch] == single
