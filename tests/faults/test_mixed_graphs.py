# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes that do not belong together: a second publisher, an earlier graph."""

import re
from pathlib import Path

import pytest
from support.in_process_graph import GraphOf
from support.runs import expected, plan, record

from ddct_bringup.run.execution import execute
from ddct_plant.base.errors import DdctError
from ddct_plant.nodes.load_node import LoadNode


def test_two_controllers_on_one_topic_are_detected(graph_of: GraphOf) -> None:
    graph = graph_of(plan('ls8'))
    graph.add_all()
    graph.add('controller', {'controller': 'pi'}, key='second')
    node, complaint = graph.first_failure()
    assert node == 'recorder'
    assert 'node /controller came twice, with controller ls8 and pi' in complaint
    assert 'ROS_DOMAIN_ID' in complaint


def test_two_controllers_of_different_names_are_both_named(graph_of: GraphOf) -> None:
    """Recorder, actuator and driveline all notice; which of them is first is chance."""
    graph = graph_of(plan('ls8'))
    graph.add_all()
    rename = ['--ros-args', '-r', 'controller:__node:=other']
    graph.add('controller', {'controller': 'pi'}, key='second', cli_args=rename)
    _, complaint = graph.first_failure()
    assert re.search('carries two different messages for stamp 1|two live publishers', complaint)
    assert '/controller and /other' in complaint


def test_a_failed_graph_in_one_process_leaves_nothing_that_the_next_receives(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fail(*_: object) -> None:
        raise DdctError('no road')

    (tmp_path / 'failed').mkdir()
    with monkeypatch.context() as broken:
        broken.setattr(LoadNode, 'answer', fail)
        with pytest.raises(DdctError, match='node load: .*no road') as kept:
            execute(plan(layout='single-process'), tmp_path / 'failed')
    run = plan(layout='single-process', wear_gain=0.6)
    assert record(run, tmp_path / 'next').trajectory.sha256() == expected(run).sha256()
    assert kept.value, 'with the error, and all that it refers to, still there'
