# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Bags recorded before flags and torque parts had topics of their own stay readable."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from refusals import refused

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.repair import repair_bag
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import DdctError
from ddct_plant.measured.columns import own_columns
from ddct_plant.measured.log import read_log
from ddct_plant.signals.topics import TOPICS, TORQUE_PARTS

EARLIER = Path(__file__).parent / 'earlier'
"""Bags of the commit in their custom data: of a run with sensors, and of one in real time."""
FLAGS = ('sensed_joint_held', 'sensed_slip_held', 'sensed_vehicle_held', 'sensed_torque_held')


@pytest.fixture(scope='module')
def sensed() -> Recording:
    """Return the recording with sensors and a closing stage."""
    return read_bag(EARLIER / 'sensed')


def test_an_earlier_bag_lacks_exactly_the_later_topics(sensed):
    later = {topic.resolved_name for topic in TOPICS if topic.later}
    assert len(later) == 3
    assert later.isdisjoint(sensed.counts)


def test_the_nodes_of_an_earlier_bag_have_full_names(sensed):
    assert sensed.run_info['/controller']['controller'] == 'pi'
    assert all(node.startswith('/') for node in sensed.run_info)


def test_every_signal_of_an_earlier_bag_equals_that_of_the_same_run_today(sensed):
    today = run_headless(sensed.settings, 'pi')
    earlier = sensed.trajectory
    assert set(earlier.signals) == set(today.signals)
    for name in set(earlier.signals) - {'status', 'phase_events'}:
        np.testing.assert_allclose(earlier.signals[name], today.signals[name], 1e-9, 1e-9, name)
    for name in FLAGS:
        assert 0 < np.sum(earlier.signals[name]) < np.size(earlier.signals[name])
        np.testing.assert_array_equal(earlier.signals[name], today.signals[name])
    assert earlier.open_loop_torque.any()
    assert earlier.closing_torque.any()
    texts = [float(dict(pairs)['closed_loop_torque_n_m']) for pairs in earlier.status]
    assert earlier.closed_loop_torque.tolist() == texts


def test_an_earlier_real_time_bag_is_scored():
    recording = read_bag(EARLIER / 'real_time')
    assert recording.missed == {}
    assert recording.realtime.steps == recording.trajectory.steps == 10
    assert (recording.trajectory.open_loop_torque > 0.0).all()
    assert score_recording(recording, 'earlier', packaged_limits()).scores.valid


def test_identification_reads_an_earlier_bag():
    log = read_log(EARLIER / 'sensed', own_columns(), ('engine_speed', 'shaft_speed'))
    assert len(log.time_s) == 13


def test_a_cut_earlier_bag_is_repaired_with_its_topics(tmp_path):
    bag = shutil.copytree(EARLIER / 'sensed', tmp_path / 'bag')
    (mcap,) = bag.glob('*.mcap')
    mcap.write_bytes(mcap.read_bytes()[:-20_000])
    with refused(DdctError, place='pi_0.mcap'):
        read_bag(bag)
    repair_bag(bag)
    repaired = read_bag(bag).trajectory
    assert repaired.steps > 0
    assert repaired.sensed_joint_held.shape == (repaired.steps + 1, 3)


def test_an_earlier_bag_of_a_node_without_texts_of_the_parts_is_read(bags):
    def without(pairs):
        return tuple(pair for pair in pairs if not pair[0].endswith('_torque_n_m'))

    sensed = read_bag(EARLIER / 'sensed').trajectory
    kept = {
        name: column
        for name, column in sensed.signals.items()
        if name not in {signal.name for signal in TORQUE_PARTS.signals}
    }
    kept['status'] = tuple(map(without, sensed.status))
    recording = read_bag(bags.write(Trajectory(kept), clutch='stick_slip'))
    assert set(recording.trajectory.signals) == set(kept)
