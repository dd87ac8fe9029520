# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lost, doubled and late messages change nothing in lock-step."""

import json
import os
import signal
import threading
import time
from pathlib import Path

import pytest
from support.hops import inputs_of
from support.in_process_graph import GraphOf, InProcessGraph
from support.processes import node_of
from support.relay import Relay, lossy_remaps
from support.runs import expected, plan, record
from support.waiting import wait_until

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.processes.graph_nodes import nodes_of
from ddct_bringup.run.plan import RunPlan
from ddct_plant.signals.topics import TOPICS

pytestmark = pytest.mark.slow


def _type_of(topic: str) -> type:
    return next(each.message_class for each in TOPICS if each.name == topic)


def _add_lossy(graph: InProcessGraph, run: RunPlan, lost: float, doubled: float) -> list[Relay]:
    relays = []
    for spec in nodes_of(shift=run.settings.shift):
        topics = inputs_of(run)[spec.path]
        graph.add(spec.path, cli_args=lossy_remaps(spec.path, topics))
        for topic in topics:
            relays.append(
                Relay(
                    spec.path,
                    topic,
                    _type_of(topic),
                    lost=lost,
                    doubled=doubled,
                    seed=1,
                    context=graph.context,
                )
            )
            graph.add_other(relays[-1])
    return relays


def _stop_for_half_a_second(module: str, bag: Path) -> None:
    """Stop a node once the first 20 kB of the run are in its bag."""
    file = bag / 'ls8_0.mcap'
    wait_until(lambda: file.exists() and file.stat().st_size > 20_000, 'a bag that grows')
    node = node_of(module)
    os.kill(node, signal.SIGSTOP)
    time.sleep(0.5)
    os.kill(node, signal.SIGCONT)


@pytest.mark.parametrize(
    'run',
    [plan(), plan('pi', scenario='upshift', duration_s=0.6, clutch='stick_slip')],
    ids=['thesis', 'upshift'],
)
def test_one_percent_lost_and_doubled_messages_change_no_bit(
    graph_of: GraphOf, run: RunPlan
) -> None:
    graph = graph_of(run)
    relays = _add_lossy(graph, run, lost=0.01, doubled=0.01)
    graph.run(within_s=60.0)
    assert sum(relay.lost for relay in relays) >= 10
    assert sum(relay.doubled for relay in relays) >= 10
    assert read_bag(graph.folder).trajectory.sha256() == expected(run).sha256()
    timing = json.loads((graph.folder / 'timing.json').read_text())
    assert timing['resends'] >= 10


def test_lost_acknowledgements_are_repeated(graph_of: GraphOf) -> None:
    run = plan(duration_s=0.5)
    graph = graph_of(run)
    graph.add('driveline', cli_args=lossy_remaps('driveline', ['recorder/ack']))
    relay = Relay(
        'driveline',
        'recorder/ack',
        _type_of('recorder/ack'),
        lost=0.2,
        doubled=0.0,
        seed=1,
        context=graph.context,
    )
    graph.add_other(relay)
    graph.add_all()
    graph.run()
    assert relay.lost >= 5
    assert read_bag(graph.folder).trajectory.sha256() == expected(run).sha256()


def test_a_node_stopped_for_half_a_second_changes_no_bit(tmp_path: Path) -> None:
    run = plan(duration_s=10.0)
    bag = tmp_path / 'bag'
    stopper = threading.Thread(target=_stop_for_half_a_second, args=('clutch_node', bag))
    stopper.start()
    recording = record(run, bag)
    stopper.join()
    assert recording.trajectory.sha256() == expected(run).sha256()
    timing = json.loads((bag / 'timing.json').read_text())
    assert timing['resends'] >= 3, 'the node was not stopped in the middle of the run'
    assert timing['steps'] == 1000
