# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes started by hand, one program each, without bringup: any order gives the same run."""

from pathlib import Path

import pytest
from support.nodes_by_hand import MODULES, RUN, finish_nodes, start_nodes
from support.observer import Observing
from support.processes import Programs
from support.runs import expected
from waiting import wait_until

from ddct_bringup.bag.reader import read_bag

pytestmark = pytest.mark.slow


def test_a_driveline_that_starts_long_before_the_others_waits_for_them(
    programs: Programs, tmp_path: Path
) -> None:
    bag = tmp_path / 'bag'
    with Observing() as observing:
        nodes = start_nodes(programs.start_node, ['driveline'], bag)
        ticks = observing.observer.joints
        wait_until(lambda: observing.listen() and 0 in ticks, 'the first tick')
    others = [name for name in MODULES if name not in ('driveline', 'recorder')]
    nodes |= start_nodes(programs.start_node, [*others, 'recorder'], bag)
    finish_nodes(nodes)
    assert read_bag(bag).trajectory.sha256() == expected(RUN).sha256()
