# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The supervisor of a graph's processes, on small programs in place of the nodes."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from waiting import WITHIN_S, wait_until

from ddct_bringup.processes import forked, shared_memory, supervisor
from ddct_bringup.processes.fork_server import server_pid, stop_server
from ddct_bringup.processes.graph_names import GraphNames
from ddct_bringup.processes.graph_nodes import NodeArguments, NodeSpec
from ddct_bringup.processes.supervisor import Node, Supervisor
from ddct_plant.base.errors import DdctError
from ddct_plant.program.supervision import Patience

pytestmark = [pytest.mark.process, pytest.mark.usefixtures('small_server')]

LIVE = """
import faulthandler, os, signal, sys, time
from ddct_plant.program.own_process import calling
from ddct_plant.program.supervision import announce_exit, beat
def leave(*_):
    announce_exit(0)
    sys.exit(0)
def main():
    {first}
    beat()
    print('ready', flush=True)
    {then}
    while True:
        beat()
        time.sleep(0.01)
"""
OBEDIENT = 'signal.signal(signal.SIGINT, leave)', 'pass'
UNWATCHED = (
    f'global beat; beat = int; faulthandler.cancel_dump_traceback_later(); {OBEDIENT[0]}',
    'pass',
)
"""As OBEDIENT, but no short patience ends it on a busy machine."""
FAILING = 'signal.signal(signal.SIGINT, lambda *_: sys.exit(1))', 'pass'
DEAF = (
    '[signal.signal(each, signal.SIG_IGN) for each in (signal.SIGINT, signal.SIGTERM)]',
    'pass',
)
ENDED, FAILED = ('pass', 'leave()'), ('pass', "print('driveline: no more disk'); return 1")
CALL = "calling('update', 65)"
HANGING = 'pass', 'time.sleep(600)'
Make = Callable[..., Supervisor]


@pytest.fixture
def processes(
    tmp_path: Path, module: Callable[[str], str], monkeypatch: pytest.MonkeyPatch
) -> Iterator[Make]:
    """Return a function that makes a supervisor of programs with these lines, by node name."""
    monkeypatch.setattr(supervisor, 'CHECK_PERIOD_S', 0.05)
    arguments = NodeArguments(Path('control'), Path('plant'), GraphNames('/car'))
    made = Supervisor(tmp_path, arguments.of)

    def make(namespace: str = '', **lines: tuple[str, str]) -> Supervisor:
        programs = {
            name: module(LIVE.format(first=first, then=then))
            for name, (first, then) in lines.items()
        }
        made.start([NodeSpec(name, each, namespace) for name, each in programs.items()])
        for node in made._nodes:
            wait_until(
                lambda node=node: 'ready' in node.printed_text() or not node.running,
                f'the start of {node.name}',
            )
        return made

    with made:
        yield make


def reason(nodes: Supervisor) -> str:
    """Return the reason with which the wait for the driveline ends."""
    with pytest.raises(DdctError) as raised:
        nodes.wait_for('driveline')
    return str(raised.value)


def node_named(nodes: Supervisor, name: str) -> Node:
    return next(node for node in nodes._nodes if node.name == name)


def let_time_pass(monkeypatch: pytest.MonkeyPatch, deaf: str) -> None:
    """Let time pass as soon as the deaf node alone goes on: each wait for the others is over."""
    now_s = 0.0
    any_ends = supervisor._any_ends

    def wait(nodes: list[Node], within_s: float) -> None:
        nonlocal now_s
        if all(node.name == deaf and not node.killed for node in nodes):
            now_s += within_s
        else:
            any_ends(nodes, WITHIN_S)

    monkeypatch.setattr(supervisor, 'time', SimpleNamespace(monotonic=lambda: now_s))
    monkeypatch.setattr(supervisor, '_any_ends', wait)


def test_a_wait_ends_with_the_node_with_its_condition_or_with_its_time(processes: Make) -> None:
    nodes = processes(driveline=OBEDIENT)
    results = iter([False, False, True])
    nodes.wait_until(lambda: next(results), WITHIN_S)
    nodes.wait_until(lambda: False, 0.1)
    node_named(nodes, 'driveline').send(signal.SIGINT)
    nodes.wait_for('driveline')
    nodes.require_clean_end()


def test_a_paused_node_is_named_and_resumed_to_end_in_order(
    processes: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(supervisor, 'PAUSED_S', 0.2)
    nodes = processes(driveline=OBEDIENT, load=OBEDIENT)
    node_named(nodes, 'load').send(signal.SIGSTOP)
    log = node_named(nodes, 'load').log
    assert reason(nodes) == f'node load has been paused (SIGSTOP) for 0.2 s; its log is {log}'
    nodes.stop(lambda name: True)
    nodes.require_clean_end()


def test_a_node_that_was_paused_for_a_while_and_time_without_checks_end_no_run(
    processes: Make,
) -> None:
    nodes = processes(driveline=OBEDIENT)
    (node,) = nodes._nodes
    node.send(signal.SIGSTOP)
    wait_until(lambda: supervisor.state_of(node.pid) == 'T', 'a pause')
    for _ in range(14):
        node.check(3600.0)
    node.send(signal.SIGCONT)
    wait_until(lambda: supervisor.state_of(node.pid) != 'T', 'the end of a pause')
    node.check(1.0)
    node.send(signal.SIGSTOP)
    wait_until(lambda: supervisor.state_of(node.pid) == 'T', 'a pause')
    node.check(14.0)


def test_a_node_that_hangs_is_named_with_its_stacks_in_its_log(
    processes: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(supervisor, 'PATIENCE', Patience(silent_s=0.3))
    nodes = processes(driveline=UNWATCHED, controller=HANGING)
    log = node_named(nodes, 'controller').log
    assert reason(nodes) == (
        f'node controller hung and ended itself, its stacks are in its log; its log is {log}'
    )
    nodes.__exit__()
    assert ' in main\n' in log.read_text(encoding='utf-8')
    nodes._nodes.clear()


def test_a_node_that_ignores_signals_is_killed_at_the_end_of_the_ladder_and_named(
    processes: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    nodes = processes(driveline=OBEDIENT, load=DEAF)
    let_time_pass(monkeypatch, 'load')
    nodes.stop(lambda name: True)
    assert [node.code() for node in nodes._nodes] == [0, -signal.SIGKILL]
    with pytest.raises(DdctError, match='node load did not stop on signals and was killed; its'):
        nodes.require_clean_end()


def test_a_node_in_a_namespace_starts_there_and_has_its_full_name_in_errors_and_logs(
    processes: Make,
) -> None:
    nodes = processes('off_going', load=('print(*sys.argv)', 'os.kill(os.getpid(), 9)'))
    (node,) = nodes._nodes
    assert reason(nodes) == f'node off_going/load was killed by SIGKILL; its log is {node.log}'
    nodes.__exit__()
    assert node.log.name == 'off_going_load.log'
    assert '-r __ns:=/car/off_going' in node.log.read_text(encoding='utf-8')
    nodes._nodes.clear()


@pytest.mark.parametrize('order', [('driveline', 'clutch'), ('clutch', 'driveline')])
@pytest.mark.parametrize('killed', [False, True])
def test_the_cause_is_the_node_that_failed_and_not_the_driveline_that_ended_after_it(
    processes: Make, order: tuple[str, ...], killed: bool
) -> None:
    """Both nodes have ended at the check: without the clutch the driveline fails too."""
    lines = {'clutch': OBEDIENT if killed else FAILED, 'driveline': FAILED}
    nodes = processes(**{name: lines[name] for name in order})
    if killed:
        node_named(nodes, 'clutch').send(signal.SIGKILL)
    for node in nodes._nodes:
        assert node.wait(WITHIN_S)
    assert reason(nodes).startswith('node clutch ')


def test_a_node_that_ended_well_is_not_the_cause_where_the_driveline_failed(
    processes: Make,
) -> None:
    nodes = processes(clutch=ENDED, driveline=FAILED)
    for node in nodes._nodes:
        assert node.wait(WITHIN_S)
    assert reason(nodes).startswith('node driveline ended with code 1: no more disk; its log')


def test_a_node_that_ends_before_the_driveline_ends_the_run(processes: Make) -> None:
    assert reason(processes(clutch=ENDED, driveline=OBEDIENT)).startswith(
        'node clutch ended with code 0: ready; its log is '
    )


def test_code_0_alone_is_no_good_end_of_a_node(processes: Make) -> None:
    """As C has it that calls exit(0): nothing is announced."""
    nodes = processes(driveline=(CALL, 'os._exit(0)'))
    expected = 'node driveline ended with code 0 when update was called at step 65: ready; its log'
    assert reason(nodes).startswith(expected)
    with pytest.raises(DdctError, match=expected):
        nodes.require_clean_end()


def test_a_node_with_code_0_alone_is_the_cause_where_the_driveline_failed_after_it(
    processes: Make,
) -> None:
    nodes = processes(driveline=FAILED, clutch=('pass', 'os._exit(0)'))
    for node in nodes._nodes:
        assert node.wait(WITHIN_S)
    assert reason(nodes).startswith('node clutch ended with code 0: ready; its log')


@pytest.mark.parametrize(
    ('then', 'expected'),
    [
        ('os.abort()', 'was killed by SIGABRT when update was called at step 65; '),
        (HANGING[1], 'hung when update was called at step 65 and ended itself, '),
        ('announce_exit(1); return 1', 'ended with code 1: ready; '),
    ],
)
def test_the_last_call_of_foreign_code_is_in_the_reason_unless_the_node_ended_in_order(
    processes: Make, monkeypatch: pytest.MonkeyPatch, then: str, expected: str
) -> None:
    monkeypatch.setattr(supervisor, 'PATIENCE', Patience(silent_s=0.3))
    nodes = processes(clutch=(CALL, then), driveline=UNWATCHED)
    assert reason(nodes).startswith(f'node clutch {expected}')


def test_a_node_killed_at_the_end_of_the_ladder_has_its_last_call_in_the_reason(
    processes: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    nodes = processes(load=(f'{DEAF[0]}; {CALL}', DEAF[1]))
    let_time_pass(monkeypatch, 'load')
    nodes.stop(lambda name: True)
    with pytest.raises(DdctError, match='signals when update was called at step 65 and was kill'):
        nodes.require_clean_end()


def test_how_a_node_ended_is_known_without_the_fork_server_too(processes: Make) -> None:
    nodes = processes(driveline=OBEDIENT, clutch=OBEDIENT, load=FAILING)
    stop_server()
    node_named(nodes, 'load').send(signal.SIGINT)
    assert node_named(nodes, 'load').wait(WITHIN_S)
    assert node_named(nodes, 'load').code() == 1
    node_named(nodes, 'clutch').send(signal.SIGKILL)
    assert node_named(nodes, 'clutch').wait(WITHIN_S)
    assert ' was killed by SIGKILL; its log is ' in node_named(nodes, 'clutch').summary()
    nodes.stop(lambda name: True)
    assert node_named(nodes, 'driveline').code() == 0
    assert not Path(f'/proc/{node_named(nodes, "driveline").pid}').exists(), 'nobody waited for it'


def test_orphans_are_adopted_during_a_run_alone(processes: Make) -> None:
    processes()
    assert parent_of_an_orphan() == os.getpid()
    processes().__exit__()
    assert parent_of_an_orphan() != os.getpid()


def parent_of_an_orphan() -> int:
    """Return the process id of the parent that a process gets when its own has ended."""
    text = 'import os, time\nwhile os.getppid() == {}: time.sleep(0.01)\nprint(os.getppid())'
    command = f'{sys.executable} -c "{text.format("$$")}" &'
    found = subprocess.run(['sh', '-c', command], stdout=subprocess.PIPE, check=True, text=True)
    with contextlib.suppress(ChildProcessError):
        os.waitpid(-1, os.WNOHANG)
    return int(found.stdout)


def test_the_end_of_a_node_whose_code_nobody_knows_is_reported(
    processes: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(forked, '_CODE_S', 0.1)
    nodes = processes(driveline=OBEDIENT, clutch=OBEDIENT)
    os.kill(server_pid(), signal.SIGSTOP)
    try:
        node_named(nodes, 'clutch').send(signal.SIGKILL)
        assert reason(nodes).startswith('node clutch has ended, and the fork server, which knows')
    finally:
        os.kill(server_pid(), signal.SIGCONT)


@pytest.mark.parametrize('number', [signal.SIGKILL, signal.SIGINT])
def test_the_shared_memory_of_a_node_that_is_killed_or_fails_is_removed_and_no_locked_one(
    processes: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: signal.Signals
) -> None:
    monkeypatch.setattr(shared_memory, 'SHARED_MEMORY', tmp_path)
    locked = 'import fcntl; lock = open({path!r}, "w"); fcntl.flock(lock, fcntl.LOCK_EX)'
    locks = [tmp_path / f'fastrtps_{index}_el' for index in range(2)]
    nodes = processes(
        driveline=(locked.format(path=str(locks[0])) + f'; {FAILING[0]}', 'pass'),
        load=(locked.format(path=str(locks[1])) + f'; {OBEDIENT[0]}', 'pass'),
    )
    for lock in locks:
        segment = lock.name.removesuffix('_el')
        (tmp_path / segment).touch()
        (tmp_path / f'sem.{segment}_mutex').touch()
    shared_memory.remove_dead_segments()
    assert len([*tmp_path.glob('*fastrtps*')]) == 6
    node_named(nodes, 'driveline').send(number)
    assert node_named(nodes, 'driveline').wait(WITHIN_S)
    shared_memory.remove_dead_segments()
    assert sorted(path.name for path in tmp_path.glob('*fastrtps*')) == [
        'fastrtps_1',
        'fastrtps_1_el',
        'sem.fastrtps_1_mutex',
    ]
    nodes.__exit__()
    assert not [*tmp_path.glob('*fastrtps*')]
    nodes._nodes.clear()


def test_the_shared_memory_of_a_node_that_hung_while_it_left_is_removed(
    processes: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shared_memory, 'SHARED_MEMORY', tmp_path)
    monkeypatch.setattr(supervisor, 'PATIENCE', Patience(leave_s=0.1))
    lock = tmp_path / 'fastrtps_1_el'
    nodes = processes(driveline=(f'open({str(lock)!r}, "w")', 'announce_exit(0); time.sleep(60)'))
    nodes.wait_for('driveline')
    nodes.require_clean_end()
    assert lock.exists()
    nodes.__exit__()
    assert not lock.exists()
    nodes._nodes.clear()


def test_the_shared_memory_of_a_node_that_ended_without_leaving_is_removed(
    processes: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shared_memory, 'SHARED_MEMORY', tmp_path)
    lock = tmp_path / 'fastrtps_1_el'
    nodes = processes(driveline=(f'open({str(lock)!r}, "w")', 'os._exit(0)'))
    assert nodes._nodes[0].wait(WITHIN_S)
    assert nodes._nodes[0].code() == 0
    assert lock.exists()
    nodes.__exit__()
    assert not lock.exists()
    nodes._nodes.clear()


def test_a_segment_that_has_just_been_made_has_time_to_be_locked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shared_memory, 'SHARED_MEMORY', tmp_path)
    lock = tmp_path / 'fastrtps_1_el'
    lock.touch()
    slept: list[float] = []
    clock = SimpleNamespace(time=lambda: lock.stat().st_mtime + 0.05, sleep=slept.append)
    monkeypatch.setattr(shared_memory, 'time', clock)
    shared_memory.remove_dead_segments()
    assert slept == [pytest.approx(0.15)]
    assert not lock.exists()


def test_a_node_has_ten_seconds_to_end_by_itself_and_five_to_be_terminated(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now_s = 0.0
    signals: list[tuple[signal.Signals, float]] = []

    def wait(_nodes: object, within_s: float) -> None:
        nonlocal now_s
        now_s += within_s

    monkeypatch.setattr(supervisor, 'time', SimpleNamespace(monotonic=lambda: now_s))
    monkeypatch.setattr(supervisor, '_any_ends', wait)
    deaf: Any = SimpleNamespace(
        name='load', running=True, stop=lambda number: signals.append((number, round(now_s, 1)))
    )
    nodes = Supervisor(Path(), lambda node: ())
    nodes._nodes = [deaf]
    nodes.stop(lambda name: True)
    assert signals == [(signal.SIGINT, 0.0), (signal.SIGTERM, 10.0), (signal.SIGKILL, 15.0)]
    assert now_s == pytest.approx(17.0, abs=0.1)


def test_a_paused_node_ends_the_run_before_its_watch_ends_it_and_both_before_the_driveline() -> (
    None
):
    from ddct_bringup.processes.graph_nodes import ANSWER_TIMEOUT_S

    for patience_s in (supervisor.PATIENCE.start_s, supervisor.PATIENCE.silent_s):
        assert patience_s > supervisor.PAUSED_S + 2.0
        assert patience_s + 1.5 < ANSWER_TIMEOUT_S


def test_ctrl_c_while_nodes_start_leaves_none(
    processes: Make, tmp_path: Path, module: Callable[[str], str]
) -> None:
    nodes = processes(driveline=OBEDIENT)
    started = time.monotonic()
    stopping = Supervisor(tmp_path, lambda node: (), lambda: True)
    with stopping, pytest.raises(KeyboardInterrupt):
        stopping.start([NodeSpec('load', module(LIVE.format(first=OBEDIENT[0], then='pass')))])
    assert time.monotonic() - started < WITHIN_S
    assert all(not node.running for node in stopping._nodes)
    assert all(node.code() != -signal.SIGTERM for node in stopping._nodes), 'SIGINT was lost'
    assert nodes._nodes[0].running
