# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What a process uses is read from /proc."""

import mmap
import os
import subprocess
import sys
import time

import pytest
from soak.process_use import MachineUse, Sample, children_by_module, sample_of, use_between


def test_a_sample_has_the_time_and_the_memory_of_a_process() -> None:
    first = sample_of(os.getpid())
    # Memory for a bytearray may be what the process kept of an earlier object: nothing would grow.
    with mmap.mmap(-1, 50_000_000) as block:
        block[:: mmap.PAGESIZE] = bytes(len(block[:: mmap.PAGESIZE]))
        until_s = time.process_time() + 0.1
        while time.process_time() < until_s:
            pass
        last = sample_of(os.getpid())
    assert first and last
    assert last.processor_s - first.processor_s >= 0.08
    assert 40.0 < use_between(first, last).growth_mb < 100.0


def test_a_use_is_the_difference_of_two_samples() -> None:
    use = use_between(Sample(10.0, 2.0, 80.0), Sample(30.0, 4.0, 81.5))
    assert (use.core_share, use.memory_mb, use.growth_mb) == (0.1, 81.5, 1.5)


def test_a_process_that_has_ended_has_no_sample() -> None:
    ended = subprocess.Popen([sys.executable, '-c', ''])
    ended.wait()
    assert sample_of(ended.pid) is None


def test_descendants_are_found_by_their_modules() -> None:
    waiting = [sys.executable, '-m', 'code', '-q']
    none = subprocess.DEVNULL
    with subprocess.Popen(waiting, stdin=subprocess.PIPE, stdout=none, stderr=none) as child:
        assert children_by_module({'code': 'name'}, os.getpid()) == {'name': child.pid}
        assert children_by_module({'other': 'name'}, os.getpid()) == {}


def test_other_programs_are_what_this_one_and_its_children_did_not_use() -> None:
    before, after = MachineUse(0.0, 100.0, 10.0, 1.0), MachineUse(10.0, 115.0, 20.0, 1.2)
    assert after.since(before) == pytest.approx((0.5, 0.02))
