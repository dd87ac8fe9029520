# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Graphs on one machine are separate, and a namespace changes nothing."""

from pathlib import Path

import pytest
from support.in_process_graph import GraphOf
from support.processes import Programs
from support.runs import bag_bytes, expected, plan

from ddct_bringup.bag.reader import read_bag


def test_two_bringups_at_once_receive_nothing_from_each_other(
    programs: Programs, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv('ROS_DOMAIN_ID')
    out = tmp_path / 'runs'
    started = [
        programs.fork(
            'ddct_bringup.programs.bringup',
            *('--controller', controller, '--duration', '1.5', '--single-process'),
            *('--out', str(out)),
        )
        for controller in ('ls8', 'pi')
    ]
    for controller, program in zip(('ls8', 'pi'), started, strict=True):
        assert program.wait() == 0, program.errors()
        trajectory = read_bag(out / controller).trajectory
        assert trajectory.sha256() == expected(plan(controller, duration_s=1.5)).sha256()


def test_a_graph_in_a_namespace_leaves_the_same_bytes(graph_of: GraphOf) -> None:
    bags = []
    for namespace in ('', '/car7/powertrain'):
        graph = graph_of(plan())
        graph.add_all(namespace=namespace)
        graph.run()
        bags.append(bag_bytes(graph.folder))
    assert bags[0] == bags[1]
