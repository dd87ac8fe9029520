# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time per step of the graph, beside a bare rclpy chain of the same nodes, hops and messages."""

import json
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from bench.peers.chain_processes import Chain
from bench.skeleton.comparison import Bench, Sides, comparison, curve
from bench.skeleton.workspace import Workspace

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.signals.topics import RunKind, recorded_topics

CHAIN = 'the bare rclpy chain'
SHIFT_CHAIN = 'the bare rclpy chain of a shift'
STEPS, FEWER_STEPS = 1000, 500
"""Steps of a run, and of a run for a point of a curve."""
SINGLE = '--single-process'


def graph_s(workspace: Workspace, *options: str, steps: int = STEPS) -> float:
    """Return the wall time per step in s of a run by `ddct bringup`, from first to last tick."""
    timing = timing_of(workspace, '--set', f'duration_s={steps * PERIOD_S}', *options)
    return timing['wall_time_s'] / timing['steps']


def timing_of(workspace: Workspace, *options: str) -> dict[str, Any]:
    """Return the `timing.json` of a run of PI by `ddct bringup`; later options win."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / 'run'
        workspace.run('ddct', 'bringup', '--controller', 'pi', *options, '--out', out)
        (timing,) = out.glob('*/timing.json')
        return json.loads(timing.read_text(encoding='utf-8'))


@comparison('graph: one process per node, step', CHAIN, at_most=1.5)
def separate_processes(bench: Bench) -> Iterator[Sides]:
    """Wall time per step of a lock-step run of 10 s with PI."""
    yield Sides(lambda: graph_s(bench.ours), Chain(STEPS).step_s, warm_up=False)


@comparison('graph: one process, step', CHAIN, at_most=1.9)
def one_process(bench: Bench) -> Iterator[Sides]:
    """Wall time per step of a lock-step run of 10 s with PI."""
    yield Sides(
        lambda: graph_s(bench.ours, SINGLE), Chain(STEPS, single=True).step_s, warm_up=False
    )


@comparison('graph: a gear shift, one process per node, step', SHIFT_CHAIN, at_most=1.5)
def shift_in_processes(bench: Bench) -> Iterator[Sides]:
    """Wall time per step of a lock-step upshift of 10 s with PI and both clutches."""
    # With little torque the engine does not over-rev within 10 s.
    engine = ('--set', 'engine.torque_n_m=[30.0]')
    options = ('--scenario', 'upshift', '--clutch', 'stick_slip', *engine)
    chain = Chain(STEPS, shift=True)
    yield Sides(lambda: graph_s(bench.ours, *options), chain.step_s, warm_up=False)


@curve('chain of processes', CHAIN, 'nodes', (8, 10, 12, 16))
def chain_of_processes(bench: Bench, nodes: int) -> Iterator[Sides]:
    """Wall time per step of a bare chain of more nodes, each with a topic of its own."""
    yield Sides(Chain(FEWER_STEPS, nodes=nodes).step_s, Chain(FEWER_STEPS).step_s, warm_up=False)


@curve('chain in one process', CHAIN, 'nodes', (8, 10, 12, 16))
def chain_in_one_process(bench: Bench, nodes: int) -> Iterator[Sides]:
    """Wall time per step of a bare chain of more nodes, each with a topic of its own."""
    longer = Chain(FEWER_STEPS, single=True, nodes=nodes)
    yield Sides(longer.step_s, Chain(FEWER_STEPS, single=True).step_s, warm_up=False)


KINDS = {
    kind: len([topic for topic in recorded_topics(kind) if topic.every_tick])
    for kind in (
        RunKind(),
        RunKind(clutch='stick_slip'),
        RunKind(clutch='stick_slip', sensed=True),
    )
}
"""Kinds of runs of which each has more topics, and their numbers of topics with every tick."""


@curve('graph in one process', CHAIN, 'topics', tuple(KINDS.values()))
def topics_of_the_graph(bench: Bench, topics: int) -> Iterator[Sides]:
    """Wall time per step of runs that record more topics: sticking plates, then sensors too."""
    (kind,) = (kind for kind, count in KINDS.items() if count == topics)
    options = ['--clutch', kind.clutch, SINGLE]
    if kind.sensed:
        options += ['--set', 'sensors.engine_speed.delay_s=0.0']
    yield Sides(
        lambda: graph_s(bench.ours, *options, steps=FEWER_STEPS),
        Chain(FEWER_STEPS, single=True).step_s,
        warm_up=False,
    )


@curve('chain in one process', CHAIN, 'topics', (*KINDS.values(), 30))
def topics_of_the_chain(bench: Bench, topics: int) -> Iterator[Sides]:
    """Wall time per step of a bare chain whose driveline publishes more topics."""
    longer = Chain(FEWER_STEPS, single=True, topics=topics)
    yield Sides(longer.step_s, Chain(FEWER_STEPS, single=True).step_s, warm_up=False)
