"""No panel of the Foxglove layout stays empty, whatever bag of ours it shows."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from layout_checks import (
    NOT_FOR_PANELS,
    Messages,
    problems,
    read_layout,
    read_messages,
    used_topics,
)
from support.runs import expected, plan

from ddct_bringup.bag.topics import TOPICS
from ddct_bringup.run.plan import RunPlan
from ddct_plant.graph.message_values import status_pairs_of

Record = Callable[[RunPlan], Messages]


@pytest.mark.parametrize('controller', ['pi', 'hinf1'])
def test_no_panel_is_empty_in_a_lock_step_bag(record: Record, controller: str) -> None:
    assert problems(read_layout(), record(plan(controller, 'headless'))) == []


def test_no_panel_is_empty_in_a_real_time_bag(record: Record) -> None:
    bag = record(plan('pi', 'single-process', mode='realtime', duration_s=0.7))
    assert '/diagnostics' in bag
    assert problems(read_layout(), bag) == []


def test_no_panel_is_empty_in_the_bag_of_a_two_input_controller(tmp_path: Path) -> None:
    pytest.importorskip('rclpy', reason='rclpy serialises the messages')
    from ddct_bringup.bag.trajectory_bag import write_trajectory

    trajectory = expected(plan('pi', duration_s=0.7))
    two_input = replace(trajectory, engine_torque_request=trajectory.engine_torque)
    run_info = {'controller': [('controller', 'made-up'), ('two_input', 'true')]}
    write_trajectory(two_input, tmp_path, 'made-up', {}, run_info)
    bag = read_messages(tmp_path)
    assert '/engine/torque_request' in bag
    assert problems(read_layout(), bag) == []


def test_the_table_of_the_run_names_the_controller(record: Record) -> None:
    *_, (_, last) = record(plan('ls8', 'headless'))['/run_info']
    assert dict(status_pairs_of(last))['controller'] == 'ls8'


def test_every_topic_is_in_a_panel_or_has_a_reason_not_to_be() -> None:
    names = {topic.resolved_name for topic in TOPICS}
    assert used_topics(read_layout()) | set(NOT_FOR_PANELS) == names
