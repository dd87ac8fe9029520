# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lost, doubled and late messages change nothing in lock-step."""

import json

import pytest
from samples import sampled
from support.altering import Lossy, add_altering, remaps
from support.hops import inputs_of
from support.in_process_graph import GraphOf, InProcessGraph
from support.runs import expected, plan

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.processes.graph_nodes import nodes_of
from ddct_bringup.run.plan import RunPlan


def _add_lossy(graph: InProcessGraph, run: RunPlan) -> list[Lossy]:
    """Let each node receive each topic by a way of its own that loses and doubles 1 % of it."""
    ways = []
    for spec in nodes_of(shift=run.settings.shift):
        topics = inputs_of(run)[spec.path]
        graph.add(spec.path, cli_args=remaps(spec.path, topics))
        for topic in topics:
            ways.append(Lossy(0.01, 0.01, f'{spec.path} {topic}'))
            add_altering(graph, topic, ways[-1], reader=spec.path)
    return ways


@pytest.mark.parametrize(
    'run',
    sampled([plan('pi', scenario='upshift', duration_s=0.6), plan()], every=2),
    ids=['upshift', 'thesis'],
)
def test_one_percent_lost_and_doubled_messages_change_no_bit(
    graph_of: GraphOf, run: RunPlan
) -> None:
    graph = graph_of(run)
    ways = _add_lossy(graph, run)
    graph.run()
    assert sum(way.lost for way in ways) >= 10
    assert sum(way.doubled for way in ways) >= 10
    assert read_bag(graph.folder).trajectory.sha256() == expected(run).sha256()
    timing = json.loads((graph.folder / 'timing.json').read_text())
    assert timing['resends'] >= 10


def test_lost_acknowledgements_are_repeated(graph_of: GraphOf) -> None:
    run = plan(duration_s=0.5)
    graph = graph_of(run)
    graph.add('driveline', cli_args=remaps('driveline', ['recorder/ack']))
    way = Lossy(0.2, 0.0, 'acknowledgements')
    add_altering(graph, 'recorder/ack', way, reader='driveline')
    graph.add_all()
    graph.run()
    assert way.lost >= 5
    assert read_bag(graph.folder).trajectory.sha256() == expected(run).sha256()
