# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Reading a bag takes memory in proportion to what is kept of it."""

import tracemalloc

from ddct_bringup.bag.reader import mcap_of, read_bag

SPARE_BYTES = 4_000_000


def test_a_bag_takes_little_more_memory_while_it_is_read_than_afterwards(bags, make_trajectory):
    bag = bags.write(make_trajectory(800))
    read_bag(bag)  # what is imported and cached is of no bag
    tracemalloc.start()
    try:
        recording = read_bag(bag)
        kept, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert recording.trajectory.steps == 800
    assert most < 2 * kept + mcap_of(bag).stat().st_size + SPARE_BYTES
