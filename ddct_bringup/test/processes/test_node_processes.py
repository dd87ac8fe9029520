# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The supervisor of a graph's processes, on small programs in place of the nodes."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from stub_programs import WITHIN_S, gone, wait_until

from ddct_bringup.processes import node_process, node_processes, shared_memory
from ddct_bringup.processes.graph_nodes import NodeSpec
from ddct_bringup.processes.node_processes import STOP_LADDER, NodeProcesses
from ddct_bringup.processes.warm_parent import WarmParent
from ddct_plant.base.errors import DdctError

pytestmark = pytest.mark.slow

LIVE = """
import os, signal, sys, time
from ddct_plant.program.supervision import announce_exit, beat
def run():
    beat()
    print('ready', flush=True)
    while True:
        beat()
        time.sleep(0.01)
def main():
    return 0
"""
OBEDIENT = 'signal.signal(signal.SIGINT, lambda *_: sys.exit(0))\nrun()\n'
DEAF = (
    'for number in (signal.SIGINT, signal.SIGTERM):\n'
    '    signal.signal(number, signal.SIG_IGN)\n'
    'run()\n'
)
HANGS_LEAVING = (
    'def leave(*_):\n'
    '    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGTERM])\n'
    '    announce_exit({code})\n'
    '    time.sleep(60)\n'
    'signal.signal(signal.SIGINT, leave)\n'
)
WORDS = "print('clutch: no more disk', flush=True); time.sleep(60)"
QUICK_LADDER = tuple((number, 1.0) for number, _ in STOP_LADDER)


@pytest.fixture
def processes(tmp_path: Path, stubs: Path, parent: WarmParent, monkeypatch: pytest.MonkeyPatch):
    """Return a function that makes a supervisor of programs with these texts, by node name."""
    monkeypatch.setattr(node_processes, 'STOP_LADDER', QUICK_LADDER)
    package = f'stubs_{tmp_path.name}'
    (stubs / package).mkdir()
    deadlines = [time.monotonic() + WITHIN_S]

    def stopped() -> bool:
        assert time.monotonic() < deadlines[-1], 'nothing was detected'
        return False

    def make(namespace: str = '', **texts: str) -> NodeProcesses:
        for name, text in texts.items():
            (stubs / package / f'{name}_node.py').write_text(LIVE + text)
        made = NodeProcesses(tmp_path, tmp_path / 'parameters.yaml', parent, stopped)
        made.__enter__()
        made.start([NodeSpec(name, f'{package}.{name}_node', namespace) for name in texts])
        for node in made._nodes:
            wait_until(lambda node=node: b'ready' in node.printed())
        deadlines.append(time.monotonic() + WITHIN_S)
        return made

    return make


def wait_as_supervisor(nodes: NodeProcesses) -> str:
    """Return the reason with which the supervisor ends after it has stopped everything."""
    try:
        with pytest.raises(DdctError) as raised:
            nodes.wait_for('driveline')
    finally:
        nodes.__exit__()
    return str(raised.value)


def test_a_stopped_driveline_is_detected_within_the_stated_time_and_everything_ends(
    processes, monkeypatch
):
    monkeypatch.setattr(node_process, 'ANSWER_TIMEOUT_S', 1.0)
    nodes = processes(driveline=OBEDIENT, load=OBEDIENT)
    nodes._check(0.0)
    nodes._nodes[0].process.send_signal(signal.SIGSTOP)
    started = time.monotonic()
    reason = wait_as_supervisor(nodes)
    assert reason.startswith('node driveline has shown no sign of life for 1 s; its log is ')
    assert time.monotonic() - started < WITHIN_S
    assert [node.process.returncode for node in nodes._nodes] == [0, 0]


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('', 'node driveline ended with code 0'),
        (OBEDIENT, 'node driveline was killed by SIGKILL'),
        (OBEDIENT, 'node driveline has shown no sign of life for 1 s'),
    ],
    ids=['ended', 'killed', 'hung'],
)
def test_nodes_are_watched_while_something_else_is_waited_for(processes, monkeypatch, text, words):
    monkeypatch.setattr(node_process, 'ANSWER_TIMEOUT_S', 1.0)
    nodes = processes(driveline=text or "print('ready', flush=True)\n", load=OBEDIENT)
    nodes._check(0.0)
    if text:
        number = signal.SIGKILL if 'killed' in words else signal.SIGSTOP
        nodes._nodes[0].process.send_signal(number)
    with pytest.raises(DdctError, match=f'^{words}'):
        nodes.wait_until(lambda: False, WITHIN_S)
    nodes.__exit__()


def test_a_node_that_was_silent_when_another_failed_is_named_too(processes, monkeypatch):
    monkeypatch.setattr(node_processes, 'SILENT_S', 0.2)
    nodes = processes(
        driveline='signal.signal(signal.SIGINT, lambda *_: sys.exit(1))\nrun()\n', load=OBEDIENT
    )
    nodes._check(0.0)
    nodes._nodes[1].process.send_signal(signal.SIGSTOP)
    nodes.wait_until(lambda: nodes._nodes[1].silence(0.2) != '', WITHIN_S)
    nodes._nodes[0].process.send_signal(signal.SIGINT)
    words = 'node driveline ended with code 1.*, and node load has shown no sign of life for 0.2 s'
    with pytest.raises(DdctError, match=f'^{words}; its log is'):
        nodes.wait_until(lambda: False, WITHIN_S)
    nodes.__exit__()


def test_a_wait_ends_with_its_condition_or_its_time(processes):
    nodes = processes(driveline=OBEDIENT)
    results = iter([False, False, True])
    nodes.wait_until(lambda: next(results), WITHIN_S)
    nodes.wait_until(lambda: False, 0.1)
    nodes.__exit__()


def test_a_node_that_never_begins_is_detected_too(processes, monkeypatch):
    monkeypatch.setattr(node_process, 'START_S', 1.0)
    reason = wait_as_supervisor(
        processes(driveline="print('ready', flush=True)\ntime.sleep(60)\n")
    )
    assert reason.startswith('node driveline has shown no sign of life for 1 s')


def test_time_in_which_the_supervisor_was_stopped_counts_for_no_missing_pulse(processes):
    nodes = processes(driveline=OBEDIENT)
    nodes._nodes[0].process.send_signal(signal.SIGSTOP)
    nodes._check(0.0)
    for _ in range(19):
        nodes._check(3600.0)
    nodes.__exit__()


def test_a_node_that_ignores_signals_is_killed_at_the_end_of_the_ladder_and_named(processes):
    nodes = processes(driveline=OBEDIENT, load=DEAF)
    nodes.stop(lambda name: True)
    assert [node.process.returncode for node in nodes._nodes] == [0, -signal.SIGKILL]
    with pytest.raises(DdctError, match='node load did not stop on signals and was killed; its'):
        nodes.require_clean_end()
    nodes.__exit__()


@pytest.mark.parametrize(
    ('end', 'words'),
    [
        ('os.kill(os.getpid(), signal.SIGKILL)', 'was killed by SIGKILL'),
        ('os._exit(1)', 'ended with code 1'),
    ],
    ids=['killed', 'failed'],
)
def test_the_shared_memory_of_a_node_that_begins_late_and_is_killed_or_fails_is_removed(
    processes, monkeypatch, tmp_path, end, words
):
    monkeypatch.setattr(shared_memory, 'SHARED_MEMORY', tmp_path)
    for name, period_s in (('CHECK_PERIOD_S', 60.0), ('STARTING_S', 0.1)):
        monkeypatch.setattr(node_processes, name, period_s)
    lock = tmp_path / 'fastrtps_1_el'
    text = (
        "print('ready', flush=True)\n"
        'time.sleep(0.5)\n'
        f"lock = open({str(lock)!r}, 'w')\n"
        'beat()\n'
        'time.sleep(0.5)\n'
        f'{end}\n'
    )
    reason = wait_as_supervisor(processes(driveline=text))
    assert reason.startswith(f'node driveline {words}')
    assert not lock.exists()


def test_a_node_that_was_killed_by_another_process_is_named_with_the_signal(processes):
    nodes = processes(driveline=OBEDIENT)
    nodes._nodes[0].process.kill()
    assert wait_as_supervisor(nodes).startswith('node driveline was killed by SIGKILL; its log')


def test_a_node_in_a_namespace_starts_there_and_has_its_full_name_in_errors_and_logs(processes):
    killed = 'print(*sys.argv, flush=True)\nos.kill(os.getpid(), signal.SIGKILL)\n'
    nodes = processes('off_going', load="print('ready', flush=True)\n" + killed)
    log = nodes._nodes[0].log
    reason = wait_as_supervisor(nodes)
    assert reason == f'node off_going/load was killed by SIGKILL; its log is {log}'
    assert log.name == 'off_going_load.log'
    assert '-r __ns:=/off_going' in log.read_text(encoding='utf-8')


def test_a_stopped_node_is_woken_to_end_in_order(processes):
    nodes = processes(driveline=OBEDIENT)
    nodes._nodes[0].process.send_signal(signal.SIGSTOP)
    nodes.stop(lambda name: True)
    nodes.require_clean_end()
    nodes.__exit__()


def test_ctrl_c_in_the_terminal_reaches_the_supervisor_alone(processes):
    nodes = processes(driveline=OBEDIENT)
    children = (nodes._nodes[0].process, nodes._guardian.process, nodes._parent.process)
    pids = [child.pid for child in children]
    assert os.getpgrp() not in [os.getpgid(pid) for pid in pids]
    nodes.__exit__()


SUPERVISOR = """
import sys, time
from pathlib import Path
from ddct_bringup.processes.graph_nodes import NodeSpec
from ddct_bringup.processes.node_processes import NodeProcesses
from ddct_bringup.processes.warm_parent import WarmParent
folder = Path(sys.argv[1])
with WarmParent() as parent, NodeProcesses(folder, folder / 'parameters.yaml', parent) as nodes:
    nodes.start([NodeSpec(name, f'stubs.{name}_node') for name in sys.argv[2:]])
    others = [nodes._guardian.process.pid, parent.process.pid]
    pids = [*(node.process.pid for node in nodes._nodes), *others]
    while not all(b'ready' in node.printed() for node in nodes._nodes):
        time.sleep(0.01)
    print(*pids, flush=True)
    time.sleep(60)
"""


LATE_GUARDIAN = """
import os, signal
from ddct_bringup.processes.warm_parent import WarmParent
forked = WarmParent._forked
def with_stopped_guardian(self, pids, jobs):
    processes = forked(self, pids, jobs)
    if jobs[0].outlives:
        os.kill(processes[0].pid, signal.SIGSTOP)
    return processes
WarmParent._forked = with_stopped_guardian
"""


@pytest.mark.parametrize(('stopped', 'late'), [(False, False), (True, False), (True, True)])
def test_after_a_killed_supervisor_every_node_ends_even_a_stopped_one(tmp_path, stopped, late):
    """The guardian is `late` where it starts to work after the end of the supervisor."""
    (tmp_path / 'stubs').mkdir()
    finishing = (
        f"signal.signal(signal.SIGTERM, lambda *_: open({str(tmp_path / 'whole')!r}, 'w').close()"
        ' or sys.exit(0))\nrun()\n'
    )
    for name, text in (('recorder', finishing), ('load', 'run()\n')):
        (tmp_path / 'stubs' / f'{name}_node.py').write_text(LIVE + text)
    paths = f'{tmp_path}:{os.environ.get("PYTHONPATH", "")}'
    supervisor = subprocess.Popen(
        [
            sys.executable,
            '-c',
            LATE_GUARDIAN * late + SUPERVISOR,
            str(tmp_path),
            'recorder',
            'load',
        ],
        stdout=subprocess.PIPE,
        env={**os.environ, 'PYTHONPATH': paths},
    )
    pids = [int(pid) for pid in supervisor.stdout.readline().split()]
    if stopped:
        os.kill(pids[0], signal.SIGSTOP)
    supervisor.kill()
    supervisor.communicate()
    if late:
        os.kill(pids[2], signal.SIGCONT)
    try:
        wait_until(lambda: all(gone(pid) for pid in pids))
    finally:
        for name, pid in zip(('recorder', 'load', 'guardian', 'warm parent'), pids, strict=True):
            if not gone(pid):
                print(f'{name} is left:\n{Path(f"/proc/{pid}/status").read_text()}')
                os.kill(pid, signal.SIGKILL)
    assert (tmp_path / 'whole').exists(), 'the recorder could not finish'


def test_the_guardian_kills_nodes_that_ignore_the_end_of_their_supervisor(tmp_path):
    ready = tmp_path / 'ready'
    deaf = subprocess.Popen(
        [
            sys.executable,
            '-c',
            'import pathlib, signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN);'
            f'pathlib.Path({str(ready)!r}).touch(); time.sleep(60)',
        ]
    )
    wait_until(ready.exists)
    guard = (
        'from ddct_bringup.processes import guardian; guardian.PATIENCE_S = 0.1;'
        f'guardian.guard(["{deaf.pid}"])'
    )
    subprocess.run([sys.executable, '-c', guard], check=True, timeout=WITHIN_S)
    assert deaf.wait(WITHIN_S) == -signal.SIGKILL


def guarded_node(tmp_path, guard):
    """
    Start a node that holds shared memory, and a guardian that runs the lines `guard` of Python.

    Return both once the guardian has printed a line, and the lock of the memory. `pid` in `guard`
    is the id of the node.
    """
    lock = tmp_path / 'fastrtps_1_el'
    node = subprocess.Popen(
        [sys.executable, '-c', f'lock = open({str(lock)!r}, "w"); input()'],
        stdin=subprocess.PIPE,
    )
    wait_until(lock.exists)
    program = (
        'import pathlib, sys\n'
        'from ddct_bringup.processes import guardian, shared_memory\n'
        f'shared_memory.SHARED_MEMORY = pathlib.Path({str(tmp_path)!r})\n'
        f'pid = "{node.pid}"\n'
    )
    guarding = subprocess.Popen(
        [sys.executable, '-c', program + guard], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    guarding.stdout.readline()
    assert lock.exists()
    return node, guarding, lock


def test_the_guardian_removes_the_shared_memory_of_a_node_that_ends_by_itself(tmp_path):
    guard = (
        'found = guardian.segments_of\n'
        'guardian.segments_of = lambda pid: [found(pid), print(flush=True)][0]\n'
        'guardian.guard([pid])'
    )
    node, guarding, lock = guarded_node(tmp_path, guard)
    node.communicate(b'\n')
    guarding.communicate(timeout=WITHIN_S)
    assert (guarding.returncode, lock.exists()) == (0, False)


def test_the_guardian_removes_the_shared_memory_of_a_node_that_is_gone_before(tmp_path):
    """A node that leaves the graph may be gone before the guardian knows of it."""
    guard = (
        'def lines():\n'
        '    yield from [pid, ""]\n'
        '    print(flush=True)\n'
        '    input()\n'
        'guardian.guard(lines())\n'
    )
    node, guarding, lock = guarded_node(tmp_path, guard)
    node.communicate(b'\n')
    assert lock.exists()
    guarding.communicate(b'\n', timeout=WITHIN_S)
    assert (guarding.returncode, lock.exists()) == (0, False)


@pytest.fixture
def quick_to_leave(monkeypatch):
    monkeypatch.setattr(node_process, 'LEAVE_S', 0.1)


def test_a_node_that_hangs_while_it_leaves_has_ended_well(processes, quick_to_leave):
    """Fast DDS may hang while a node leaves."""
    nodes = processes(driveline=OBEDIENT, clutch=HANGS_LEAVING.format(code=0) + 'run()\n')
    nodes.stop(lambda name: True)
    nodes.require_clean_end()
    nodes.__exit__()


def test_its_own_exit_code_counts(processes, quick_to_leave):
    text = HANGS_LEAVING.format(code=1) + 'run()\n'
    nodes = processes(driveline=OBEDIENT, clutch=text.replace('time.sleep(60)', WORDS))
    nodes.stop(lambda name: True)
    with pytest.raises(DdctError, match='node clutch ended with code 1: no more disk'):
        nodes.require_clean_end()
    nodes.__exit__()


def test_the_owner_of_time_may_hang_while_it_leaves(processes, quick_to_leave):
    nodes = processes(
        driveline=HANGS_LEAVING.format(code=0) + "print('ready', flush=True)\nleave()\n"
    )
    nodes.wait_for('driveline')
    nodes.require_clean_end()
    nodes.__exit__()


@pytest.mark.parametrize('order', [('driveline', 'clutch'), ('clutch', 'driveline')])
@pytest.mark.parametrize('code', [1, -signal.SIGKILL])
def test_the_cause_is_the_node_that_failed_and_not_the_driveline_that_ended_after_it(
    processes, order, code
):
    """Both nodes have ended at the check: without the clutch the driveline fails too."""
    programs = {
        'clutch': OBEDIENT if code < 0 else "print('ready', flush=True); sys.exit(1)",
        'driveline': "print('ready', flush=True); sys.exit(1)",
    }
    nodes = processes(**{name: programs[name] for name in order})
    if code < 0:
        next(node for node in nodes._nodes if node.name == 'clutch').process.kill()
    for node in nodes._nodes:
        node.process.wait(WITHIN_S)
    assert wait_as_supervisor(nodes).startswith('node clutch ')


def test_a_node_that_ended_well_is_not_the_cause_where_the_driveline_failed(processes):
    done = "print('ready', flush=True)"
    nodes = processes(clutch=done, driveline="print('ready', flush=True); sys.exit(1)")
    for node in nodes._nodes:
        node.process.wait(WITHIN_S)
    assert wait_as_supervisor(nodes).startswith('node driveline ended with code 1')
