# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`identify` reads a bag by the reader of all programs: whole and undamaged, or not at all."""

import random
from pathlib import Path

import numpy as np
import pytest
from refusals import refused

from ddct_bringup.bag.reader import mcap_of
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.logs.columns import own_columns
from ddct_bringup.logs.log import MeasuredLog, read_log
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step


def log_of(bag: Path) -> MeasuredLog:
    """Return a bag as `identify` reads it."""
    return read_log(bag, own_columns(), ('engine_speed', 'engine_torque'))


def test_every_flipped_bit_is_detected(bags, trajectory) -> None:
    file = mcap_of(bags.write(trajectory))
    whole = file.read_bytes()
    assert np.array_equal(log_of(file).signals['vehicle_accel'][::10], trajectory.vehicle_accel)
    rng = random.Random(7)
    for place in rng.sample(range(len(whole)), 30):
        damaged = bytearray(whole)
        damaged[place] ^= 1 << rng.randrange(8)
        file.write_bytes(damaged)
        with refused(DdctError, place='pi_0.mcap'):
            log_of(file)


@pytest.mark.parametrize(
    'edit',
    [
        lambda messages: [each for each in messages if each[0] != '/engine/torque'],
        lambda messages: messages[:200] + messages[230:],
        lambda messages: messages + messages[-20:],
    ],
)
def test_a_missing_or_doubled_message_is_an_error(bags, trajectory, edit) -> None:
    odd = bags.rewrite(bags.write(trajectory), 'odd', edit)
    with pytest.raises(DdctError, match='odd'):
        log_of(odd)


def test_a_stamp_far_beyond_the_last_is_refused(bags, trajectory) -> None:
    def far(messages):
        topic, _, data = next(each for each in messages if each[0] == '/driveline/joint_states')
        late = (2**31 - 1).to_bytes(4, 'little') + bytes(4)
        return [*messages, (topic, (2**31 - 1) * 10**9, data[:4] + late + data[12:])]

    odd = bags.rewrite(bags.write(trajectory), 'odd', far)
    with pytest.raises(DdctError, match='odd_0.mcap: '):
        log_of(odd)


def test_a_missing_tick_is_named(bags, trajectory) -> None:
    def gap(messages):
        return [each for each in messages if each[1] != stamp_of_step(17)]

    with refused(DdctError, '/driveline/joint_states', place='odd_0.mcap') as caught:
        log_of(bags.rewrite(bags.write(trajectory), 'odd', gap))
    assert 'no message at step 17' in str(caught.value)


def test_a_value_that_is_not_finite_is_an_error(bags, trajectory) -> None:
    spoiled = trajectory.engine_torque.copy()
    spoiled[5] = np.nan
    run = Trajectory({**trajectory.signals, 'engine_torque': spoiled})
    with pytest.raises(DdctError, match='engine_torque'):
        log_of(bags.write(run))
