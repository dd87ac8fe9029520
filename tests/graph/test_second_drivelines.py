# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A second graph with the clock of another is refused; one on nodes that have run says so."""

import os
import re
import signal
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from samples import sampled
from support.complaints import assert_one_line
from support.documented import ROOT
from support.nodes_by_hand import MODULES, RUN, finish_nodes, start_nodes
from support.processes import Program, Programs, ros_arguments
from support.runs import expected, plan
from waiting import wait_until

from ddct_bringup.bag.reader import read_bag
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.domain import LAST_DOMAIN, own_domain, sole_graph
from ddct_plant.signals.topics import CLOCK

FOLLOWERS = [name for name in MODULES if name not in ('driveline', 'recorder')]
DRIVELINE = MODULES['driveline']
SHORT = {'duration': 0.1, 'require_recorder': False, 'answer_timeout_s': 600.0}

LONG_S = 15.0
"""Duration in s of a run that lasts several times as long as another one needs to start."""


def test_a_driveline_that_is_started_again_on_the_same_nodes_says_that_they_have_run(
    programs: Programs,
) -> None:
    nodes = start_nodes(programs.start_node, FOLLOWERS, None)
    first = programs.start_node(DRIVELINE, SHORT)
    assert first.wait() == 0, first.errors()
    second = programs.start_node(DRIVELINE, SHORT)
    assert second.wait() == 1
    assert_one_line(second.errors(), 'driveline', 'have already run with another driveline')
    for node in nodes.values():
        node.stop()


def test_a_driveline_beside_another_is_refused_and_disturbs_nothing(programs: Programs) -> None:
    first = programs.start_node(DRIVELINE, {'answer_timeout_s': 600.0})

    def kept() -> bool:
        try:
            with own_domain() as domain, sole_graph(domain, CLOCK.resolved_name):
                return False
        except DdctError:
            return True

    wait_until(kept, 'a driveline that has begun')
    second = programs.start_node(DRIVELINE, {})
    assert second.wait() == 1
    assert_one_line(second.errors(), 'driveline', 'another graph runs', 'with /clock in')
    first.stop()


@pytest.mark.parametrize('layout', sampled([['--single-process'], []], every=2))
def test_a_bringup_beside_another_in_one_domain_is_refused_and_the_first_goes_on(
    programs: Programs, tmp_path: Path, layout: list[str]
) -> None:
    def start(out: str) -> list[str]:
        options = ['--controller', 'ls8', '--duration', f'{LONG_S:g}', *layout]
        return ['ddct_bringup.programs.bringup', *options, '--out', str(tmp_path / out)]

    first = programs.fork(*start('first'))
    bag = tmp_path / 'first' / 'ls8.partial' / 'ls8_0.mcap'
    wait_until(lambda: bag.exists() or first.process.poll() is not None, 'a bag')
    second = programs.fork(*start('second'))
    assert second.wait() == 1
    with own_domain() as domain:
        words = f'another graph runs on this machine with /clock in ROS domain {domain}: wait'
    assert_one_line(second.errors(), 'bringup', words)
    assert first.wait() == 0, first.errors()
    trajectory = read_bag(tmp_path / 'first' / 'ls8').trajectory
    assert trajectory.sha256() == expected(plan(duration_s=LONG_S)).sha256()


def test_domains_and_clocks_are_kept_apart() -> None:
    long = f'/{"a" * 300}/clock'
    clock = CLOCK.resolved_name
    domain = LAST_DOMAIN + 2 * os.getpid()  # no graph of this machine is there
    with (
        sole_graph(domain, clock),
        sole_graph(domain + 1, clock),
        sole_graph(domain, '/car/clock'),
        sole_graph(domain, long),
    ):
        again = pytest.raises(DdctError, match=f'with /car/clock in ROS domain {domain}: wait for')
        with again, sole_graph(domain, '/car/clock'):
            pass
    with sole_graph(domain, '/car/clock'):
        pass


def test_two_graphs_in_one_domain_run_with_a_namespace_and_a_clock_each(
    programs: Programs, tmp_path: Path
) -> None:
    """One is a gear shift that `bringup` starts, the other has an engine of a third party."""

    def names(car: str) -> list[str]:
        topics = ('clock', 'diagnostics')
        renamed = [each for name in topics for each in ('-r', f'/{name}:=/{car}/{name}')]
        return ['-r', f'__ns:=/{car}', *renamed]

    def start_node(module: str, parameters: Mapping[str, object]) -> Program:
        return programs.fork(module, *ros_arguments(parameters), *names('hand'))

    others = [name for name in MODULES if name != 'engine']
    nodes = start_nodes(start_node, others, tmp_path / 'hand')
    example = str(ROOT / 'docs' / 'examples' / 'own_engine.py')
    engine = programs.start([sys.executable, example, '--ros-args', *names('hand')])
    bringup = programs.fork(
        'ddct_bringup.programs.bringup',
        *('--scenario', 'upshift', '--single-process', '--out', str(tmp_path / 'shift')),
        *('--ros-args', *names('shift')),
    )
    finish_nodes(nodes)
    assert bringup.wait() == 0, bringup.errors()
    engine.send(signal.SIGKILL)  # an example may hang as it leaves the graph
    for folder, run in (
        ('hand', RUN),
        ('shift/pi', plan('pi', scenario='upshift', duration_s=2.5)),
    ):
        assert read_bag(tmp_path / folder).trajectory.sha256() == expected(run).sha256()

    (told,) = re.findall(r'^\[INFO\].*', nodes['clutch'].errors(), re.MULTILINE)
    assert told.endswith(
        '[hand.clutch]: torque between the plates of a clutch: waits for /hand/actuator/torque'
    )
    assert '[INFO]' not in bringup.errors()
