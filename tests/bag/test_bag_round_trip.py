# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Trajectory and facts are read from a bag as written, to the last bit and byte."""

import ctypes
import math

import numpy as np
import pytest
from message_counts import message_counts
from refusals import refused

from ddct_bringup.bag.reader import mcap_of, read_bag
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.writer import BagWriter
from ddct_plant.bag_file.records import read_records
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import START_NS, stamp_of_step
from ddct_plant.signals.message_kind import Numbers
from ddct_plant.signals.topic import RunKind, Topic
from ddct_plant.signals.topics import recorded_topics


def test_trajectory_comes_back_to_the_last_bit(bags, trajectory):
    recording = read_bag(bags.write(trajectory))
    assert recording.trajectory.sha256() == trajectory.sha256()
    assert 'engine_torque_request' not in recording.trajectory.signals
    assert recording.missed == {}


def test_a_stick_slip_run_comes_back_with_its_phases(bags, make_trajectory):
    run = make_trajectory(60, clutch='stick_slip')
    bag = bags.write(run, clutch='stick_slip')
    recording = read_bag(bag)
    assert recording.trajectory.sha256() == run.sha256()
    assert recording.trajectory.phase_events == run.phase_events
    assert message_counts(bag)['/clutch/phase'] == run.steps + 1


def test_run_info_facts_and_counts_come_back(bags, trajectory):
    bag = bags.write(trajectory, wear_gain=0.7)
    recording, counts = read_bag(bag), message_counts(bag)
    assert recording.run_info == {
        '/engine': {'version': '1.0', 'two_input': 'false'},
        '/load': {'version': '1.0'},
    }
    assert recording.facts.wear_gain == 0.7
    assert counts.pop('/run_info') == 2
    assert set(counts.values()) == {trajectory.steps + 1}


def test_two_input_runs_carry_the_engine_torque_request(bags, trajectory):
    request = np.random.default_rng(3).normal(size=trajectory.steps + 1)
    two_input = Trajectory({**trajectory.signals, 'engine_torque_request': request})
    recording = read_bag(bags.write(two_input))
    assert np.array_equal(recording.trajectory.engine_torque_request, request)
    assert recording.trajectory.sha256() == two_input.sha256() != trajectory.sha256()


def test_non_finite_values_come_back(bags, trajectory):
    spoiled = trajectory.torque_request.copy()
    spoiled[5:8] = math.nan, math.inf, -math.inf
    run = Trajectory({**trajectory.signals, 'torque_request': spoiled})
    recording = read_bag(bags.write(run))
    assert np.array_equal(recording.trajectory.torque_request, spoiled, equal_nan=True)


def test_every_tick_is_written_in_the_order_of_the_topic_table(bags, trajectory):
    messages = list(read_records(mcap_of(bags.write(trajectory))).messages())
    assert [(topic, stamp) for topic, stamp, _ in messages[:2]] == [('/run_info', START_NS)] * 2
    order = [topic.resolved_name for topic in recorded_topics(RunKind()) if topic.every_tick]
    expected = [(topic, stamp_of_step(k)) for k in range(trajectory.steps + 1) for topic in order]
    assert [(topic, stamp) for topic, stamp, _ in messages[2:]] == expected


def spoil_free_memory(byte):
    """Fill freed blocks of the sizes that messages have, so that unset bytes show."""
    libc = ctypes.CDLL(None)
    libc.malloc.restype = ctypes.c_void_p
    libc.malloc.argtypes = [ctypes.c_size_t]
    libc.free.argtypes = [ctypes.c_void_p]
    blocks = []
    for size in range(8, 2048, 8):
        for _ in range(8):
            blocks.append(libc.malloc(size))
            ctypes.memset(blocks[-1], byte, size)
    for block in blocks:
        libc.free(block)


def test_equal_runs_give_equal_bytes_whatever_was_in_memory(bags, trajectory):
    written = []
    for byte in (0x00, 0x55, 0xFF):
        spoil_free_memory(byte)
        bag = bags.write(trajectory, folder=f'memory-{byte}')
        written.append([file.read_bytes() for file in sorted(bag.iterdir())])
    assert len(written[0]) == 2
    assert written[0] == written[1] == written[2]


def test_a_different_last_bit_gives_different_bytes(bags, trajectory):
    changed = trajectory.slip_speed.copy()
    changed[30] = np.nextafter(changed[30], math.inf)
    first = bags.write(trajectory, folder='first')
    other = Trajectory({**trajectory.signals, 'slip_speed': changed})
    second = bags.write(other, folder='second')
    assert mcap_of(first).read_bytes() != mcap_of(second).read_bytes()


def test_rewriting_a_bag_gives_the_same_bytes(bags, trajectory):
    first = bags.write(trajectory, folder='first')
    second = bags.rewrite(first, 'pi')
    assert mcap_of(first).read_bytes() == mcap_of(second).read_bytes()


def test_a_bag_holds_no_path(bags, trajectory):
    bag = bags.write(trajectory)
    for file in bag.iterdir():
        assert str(bags.folder).encode() not in file.read_bytes()


def test_an_existing_bag_is_never_overwritten(bags, trajectory):
    bag = bags.write(trajectory)
    before = mcap_of(bag).read_bytes()
    with pytest.raises(DdctError, match='pi_0.mcap: already there'):
        bags.write(trajectory)
    assert mcap_of(bag).read_bytes() == before


def test_a_topic_the_bag_was_opened_without_is_refused(tmp_path):
    bag = BagWriter(tmp_path, 'x', recorded_topics(RunKind()), {})
    with pytest.raises(DdctError, match='without a topic controller/timing'):
        bag.write('controller/timing', START_NS, b'')


def test_an_unknown_message_type_is_an_error_that_names_where_to_define_it(tmp_path):
    topic = Topic('x', Numbers('no_such_msgs/msg/Thing'), 'nobody')
    with refused(DdctError, 'no_such_msgs/msg/Thing'):
        BagWriter(tmp_path, 'x', [topic], {})


def test_an_exception_leaves_the_bag_unfinished(tmp_path):
    empty: dict[str, int] = {}
    with pytest.raises(KeyError), BagWriter(tmp_path, 'x', recorded_topics(RunKind()), {}):
        empty.pop('no such key')
    assert not (tmp_path / 'metadata.yaml').exists()
    with pytest.raises(DdctError, match='x_0.mcap: '):
        read_bag(tmp_path)


def test_a_folder_that_cannot_be_made_is_an_error(tmp_path):
    (tmp_path / 'file').write_text('in the way')
    with pytest.raises(DdctError, match='x_0.mcap: cannot write the recording'):
        BagWriter(tmp_path / 'file' / 'x', 'x', recorded_topics(RunKind()), {})
