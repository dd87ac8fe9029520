# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Two live publishers of one topic of the loop end the run, and both are named."""

import pytest
from support.in_process_graph import GraphOf
from support.second_publishers import LOOP, NODE_NAMES, require_named_copy, require_named_echo

from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import OFF_GOING_CLUTCH_TORQUE, SHIFT_TOPICS

ECHOED = [topic for topic in LOOP if topic not in SHIFT_TOPICS] + [OFF_GOING_CLUTCH_TORQUE]
"""Topics of the loop of other runs, and one of a shift, where the check is the same."""
COPIED = [
    *(name for name in NODE_NAMES if name not in ('driveline', 'recorder')),
    *('handover', 'off_going/actuator'),
]
"""Nodes but those of which a second one ends itself."""


@pytest.mark.parametrize('topic', ECHOED, ids=lambda topic: topic.name)
def test_a_second_publisher_of_any_loop_topic_ends_the_run_with_its_name(
    graph_of: GraphOf, topic: Topic
) -> None:
    require_named_echo(graph_of, topic)


@pytest.mark.parametrize('recorded', [True, False], ids=['recorded', 'not recorded'])
@pytest.mark.parametrize('name', COPIED)
def test_a_second_copy_of_any_node_ends_the_run_with_its_name(
    graph_of: GraphOf, name: str, recorded: bool
) -> None:
    require_named_copy(graph_of, name, recorded=recorded)
