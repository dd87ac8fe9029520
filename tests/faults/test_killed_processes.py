# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Killed and interrupted processes: a reason, no process left, no partial result as complete."""

import json
import os
import signal
from collections.abc import Iterable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from support.complaints import assert_one_line
from support.processes import Program, Programs, fork_server_of, node_of, processes_left
from support.runs import expected, plan
from support.shared_memory import has_owner, segments_of
from waiting import wait_until

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.programs import score
from ddct_bringup.run.execution import execute
from ddct_plant.graph.domain import own_domain
from ddct_plant.graph.half_made_ports import SHARED_MEMORY

SHIFT = {'scenario': 'upshift'}
ENDLESS = ('--controller', 'ls8', '--duration', '3600')


def _running(programs: Programs, out: Path, *options: str) -> Program:
    """
    Start an endless bringup and wait until its recorder has written some steps.

    Its errors are all that it has printed.
    """
    bringup = programs.fork('ddct_bringup.programs.bringup', *ENDLESS, *options, '--out', str(out))
    bag = out / 'ls8.partial' / 'ls8_0.mcap'

    def under_way() -> bool:
        grown = bag.exists() and bag.stat().st_size > 50_000
        return grown or bringup.process.poll() is not None

    wait_until(under_way, 'a bag that grows')
    assert bringup.process.poll() is None, bringup.errors()
    return bringup


def _require_whole_until_its_end(bag: Path, **options: Any) -> int:
    """
    Require that a bag can be read and has the first steps of the run; return their number.

    `options` are those of `plan`.
    """
    trajectory = read_bag(bag).trajectory
    steps = trajectory.steps
    # The length of the run changes nothing before its end.
    whole = expected(plan(duration_s=steps / 100, **options))
    assert trajectory.sha256() == whole.sha256()
    return steps


@pytest.mark.parametrize(('node', 'options'), [('clutch', {}), ('handover', SHIFT)])
def test_a_killed_node_is_named_and_what_was_recorded_is_kept(
    programs: Programs, tmp_path: Path, node: str, options: dict[str, str]
) -> None:
    given = [part for key, value in options.items() for part in (f'--{key}', value)]
    bringup = _running(programs, tmp_path / 'runs', *given)
    os.kill(node_of(f'{node}_node'), signal.SIGKILL)
    assert bringup.wait() == 1
    assert not processes_left()
    assert_one_line(bringup.errors(), 'bringup', f'node {node} was killed by SIGKILL')
    assert not (tmp_path / 'runs' / 'ls8').exists()
    assert _require_whole_until_its_end(tmp_path / 'runs' / 'ls8.partial', **options) > 20


def test_score_reads_what_a_killed_recorder_wrote_and_gives_no_figures(
    programs: Programs, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    bringup = _running(programs, tmp_path / 'runs')
    os.kill(node_of('recorder_node'), signal.SIGKILL)
    assert bringup.wait() == 1
    assert not processes_left()
    assert_one_line(bringup.errors(), 'bringup', 'node recorder was killed by SIGKILL')
    bag = tmp_path / 'runs' / 'ls8.partial'
    steps = _require_whole_until_its_end(bag)
    assert steps > 20
    assert score.main([str(bag), '--json', '-']) == 1
    (run,) = json.loads(capfd.readouterr().out)['runs']
    assert (run['valid'], run['state'], {*run['figures'].values()}) == (False, 'invalid', {None})
    assert run['reason'] == (
        f'incomplete: {steps} of 360000 steps: if its recorder still runs, stop it first'
    )


@pytest.mark.parametrize(
    ('number', 'layout'),
    [
        (signal.SIGINT, []),
        (signal.SIGTERM, ['--single-process']),
    ],
    ids=['SIGINT to processes', 'SIGTERM to a single process'],
)
def test_an_interrupted_bringup_stops_its_nodes_and_keeps_what_was_recorded(
    programs: Programs, tmp_path: Path, number: signal.Signals, layout: list[str]
) -> None:
    bringup = _running(programs, tmp_path / 'runs', *layout)
    bringup.send(number)
    assert bringup.wait(20.0) == 128 + number
    assert not processes_left()
    recorded = f'what was recorded is in {tmp_path / "runs" / "ls8.partial"}'
    assert_one_line(bringup.errors(), 'bringup', 'interrupted', recorded)
    assert not (tmp_path / 'runs' / 'ls8').exists()
    assert _require_whole_until_its_end(tmp_path / 'runs' / 'ls8.partial') > 20


def test_the_nodes_of_a_killed_bringup_end_by_themselves(
    programs: Programs, tmp_path: Path
) -> None:
    bringup = _running(programs, tmp_path / 'runs')
    processes = processes_left()
    assert len(processes) == 10, 'bringup, the fork server and the nodes'
    # Ports are shared, and used again by graphs of others.
    own = [name for pid in processes for name in segments_of(pid) if 'port' not in name]
    assert len(own) == len(set(own)) >= 8, 'each node has its own'
    bringup.send(signal.SIGKILL)
    bringup.wait()
    wait_until(lambda: not processes_left(), 'no node left', 20.0)
    there = {file.name for file in SHARED_MEMORY.iterdir()}
    assert not _left_without_owner(own, there)
    assert not (tmp_path / 'runs' / 'ls8').exists()
    assert _require_whole_until_its_end(tmp_path / 'runs' / 'ls8.partial') > 20


def test_a_run_goes_on_without_the_fork_server_that_forked_its_nodes(
    programs: Programs, tmp_path: Path
) -> None:
    out = tmp_path / 'runs'
    bringup = programs.fork(
        *('ddct_bringup.programs.bringup', '--controller', 'ls8', '--duration', '4'),
        *('--out', str(out)),
    )
    wait_until(lambda: (out / 'ls8.partial' / 'ls8_0.mcap').exists(), 'a bag')
    os.kill(fork_server_of(bringup), signal.SIGKILL)
    assert bringup.wait() == 0, bringup.errors()
    assert _require_whole_until_its_end(out / 'ls8') == 400


def _segments(node: Program) -> set[str]:
    """Return the shared-memory segments of a node that was started by hand, once it has some."""
    found: set[str] = set()

    def look() -> bool:
        found.update(segments_of(node.process.pid))
        return len(found) >= 2

    wait_until(look, 'shared memory')
    return found


def _left_without_owner(segments: Iterable[str], there: set[str]) -> set[str]:
    """
    Return the segments with files among those `there` that no live process has locked.

    The ports from 7000 on have the same numbers in all domains, so that another graph of the
    machine may have taken one over since its owner was killed.
    """
    left = {segment for segment in segments if any(segment in name for name in there)}
    return {segment for segment in left if not has_owner(segment)}


def test_a_graph_runs_in_a_domain_where_a_node_was_killed_while_it_made_a_port(
    tmp_path: Path,
) -> None:
    first = 7400 + 250 * int(os.environ['ROS_DOMAIN_ID'])
    for number in (first + 10, first + 11):
        port = SHARED_MEMORY / f'fastrtps_port{number}'
        port.unlink(missing_ok=True)
        port.write_bytes(bytes(52400))
        os.utime(port, (0, 0))
    whole = plan(duration_s=0.2)
    execute(whole, tmp_path)
    assert read_bag(tmp_path).trajectory.sha256() == expected(whole).sha256()


def test_bringup_removes_the_shared_memory_of_dead_nodes_and_of_no_live_one(
    programs: Programs, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    domain = os.environ['ROS_DOMAIN_ID']
    with ExitStack() as others:
        # The middleware of a node in the same domain would clean up after a dead one.
        monkeypatch.delenv('ROS_DOMAIN_ID')
        others.enter_context(own_domain())
        live = programs.start_node('ddct_plant.nodes.load_node', {})
        monkeypatch.setenv('ROS_DOMAIN_ID', domain)
        foreign = _segments(live)
        bringup = _running(programs, tmp_path / 'runs')
        clutch = node_of('clutch_node')
        own = segments_of(clutch)
        assert len(own) >= 2
        os.kill(clutch, signal.SIGKILL)
        assert bringup.wait() == 1
        there = {file.name for file in SHARED_MEMORY.iterdir()}
        assert not _left_without_owner(own, there)
        assert {f'{segment}_el' for segment in foreign} <= there
        live.stop()
