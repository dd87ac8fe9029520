# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A process of a node that is stopped for a while, or for good, by the wall clock."""

import json
import os
import signal
import threading
import time
from functools import partial
from pathlib import Path

import pytest
from support.in_process_graph import GraphOf
from support.processes import Programs, node_of
from support.runs import expected, plan, record
from support.waiting import wait_until

from ddct_plant.signals.topics import CLUTCH_TORQUE, LOAD_TORQUE
from ddct_plant.ticks.realtime_owner import RealtimeOwner

PATIENCE_S = 20.0
"""Time in s that the driveline waits for an answer here; 60 s for users."""


def _stop_for_half_a_second(module: str, bag: Path) -> None:
    """Stop a node once the first 20 kB of the run are in its bag."""
    file = bag / 'ls8_0.mcap'
    wait_until(lambda: file.exists() and file.stat().st_size > 20_000, 'a bag that grows')
    node = node_of(module)
    os.kill(node, signal.SIGSTOP)
    time.sleep(0.5)
    os.kill(node, signal.SIGCONT)


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


def test_a_process_that_hangs_ends_the_run_at_its_step(
    graph_of: GraphOf, programs: Programs
) -> None:
    graph = graph_of(plan(duration_s=600.0), wall_clock=True)
    graph.parameters['driveline']['answer_timeout_s'] = PATIENCE_S
    clutch = programs.start_node('ddct_plant.nodes.clutch_node', graph.parameters['*'])
    graph.wait_for_publishers('clutch/torque')
    graph.add('driveline', {'require_recorder': False})
    graph.add_all(without=['clutch', 'recorder'])
    graph.spin_until(lambda: graph.driveline.owner.step >= 20, 'step 20')
    clutch.send(signal.SIGSTOP)
    node, complaint = graph.first_failure()
    assert node == 'driveline'
    stamp = 10**9 + graph.driveline.owner.step * 10**7
    assert complaint.startswith(f'no clutch/torque for stamp {stamp} ns')
    assert f'within {PATIENCE_S:g} s' in complaint


@pytest.mark.parametrize(
    ('name', 'topic'), [('load', LOAD_TORQUE.name), ('clutch', CLUTCH_TORQUE.name)]
)
def test_a_node_that_was_stopped_in_real_time_answers_again_when_it_goes_on(
    graph_of: GraphOf, programs: Programs, name: str, topic: str
) -> None:
    graph = graph_of(plan(mode='realtime', duration_s=600.0), wall_clock=True)
    node = programs.start_node(f'ddct_plant.nodes.{name}_node', graph.parameters['*'])
    graph.wait_for_publishers(topic)
    graph.add_all(without=[name])
    owner = graph.driveline.owner
    assert isinstance(owner, RealtimeOwner)

    def reached(step: int) -> bool:
        return owner.step >= step

    def answered(missed: int, start: int) -> bool:
        """Return whether a step since then was not missed."""
        return owner.missed_replies[topic] - missed < owner.step - start

    for _ in range(2):
        start = owner.step
        graph.spin_until(partial(reached, start + 50), 'half a second')
        node.send(signal.SIGSTOP)
        graph.spin_until(partial(reached, start + 100), 'half a second more')
        node.send(signal.SIGCONT)
        so_far = owner.missed_replies[topic], owner.step
        graph.spin_until(partial(answered, *so_far), f'{topic} in time once more')
