# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller node that leaves `controller/torque_parts` out gives the same run without it."""

import itertools
from pathlib import Path
from typing import Any

import pytest
from message_counts import message_counts
from samples import sampled
from support.in_process_graph import InProcessGraph, node_class
from support.runs import expected, plan

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.trajectory_bag import write_trajectory
from ddct_plant.graph.node_reports import PARTS
from ddct_plant.signals.topics import TORQUE_PARTS

LATE_S = 0.2
"""Time from the start of the node to its `run_info`, s: t_0 is answered long before."""
NAMES = {signal.name for signal in TORQUE_PARTS.signals}


def without_parts(monkeypatch: pytest.MonkeyPatch, *, publishes: bool) -> None:
    """Let the controller's node announce no parts, late; `publishes` them all the same or not."""
    node: Any = node_class('controller')
    answer, publish_run_info = node.answer, node.publish_run_info

    def some(self: Any, *arguments: Any) -> Any:
        reply = answer(self, *arguments)
        return reply if publishes else [each for each in reply if each is not self._parts]

    def late(self: Any, info: dict[str, str]) -> None:
        def publish() -> None:
            timer.cancel()
            publish_run_info(self, {key: info[key] for key in info if key != PARTS})

        timer = self.every(LATE_S, publish)

    monkeypatch.setattr(node, 'answer', some)
    monkeypatch.setattr(node, 'publish_run_info', late)


@pytest.mark.parametrize(
    ('mode', 'publishes'),
    sampled(itertools.product(['lockstep', 'realtime'], [False, True]), every=3),
)
def test_a_run_without_the_parts_lacks_nothing_else(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, mode: str, publishes: bool
) -> None:
    run = plan('pi', 'single-process', mode=mode, duration_s=0.8)
    without_parts(monkeypatch, publishes=publishes)
    with InProcessGraph(run, tmp_path / 'pi') as graph:
        graph.add_all()
        graph.run()
    recording = read_bag(tmp_path / 'pi')
    assert TORQUE_PARTS.resolved_name not in message_counts(tmp_path / 'pi')
    whole = expected(plan('pi', duration_s=0.8)).signals
    assert set(recording.trajectory.signals) == set(whole) - NAMES
    assert recording.trajectory.open_loop_torque is None
    assert set(recording.absent) == NAMES
    assert recording.missed == {} or mode == 'realtime'
    if mode == 'lockstep':
        assert recording.trajectory.torque_request.tolist() == whole['torque_request'].tolist()


def test_the_bag_of_a_run_without_the_parts_has_the_bytes_of_the_recorders(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    run = plan('pi', 'single-process', duration_s=0.3)
    without_parts(monkeypatch, publishes=False)
    with InProcessGraph(run, tmp_path / 'pi') as graph:
        graph.add_all()
        graph.run()
    recording = read_bag(tmp_path / 'pi')
    again = write_trajectory(
        recording.trajectory,
        tmp_path / 'again',
        'pi',
        recording.custom_data,
        recording.run_info,
    )
    assert again.read_bytes() == recording.path.read_bytes()
