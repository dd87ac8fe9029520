# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Forks of the warm parent are like new processes, and none is left behind."""

import contextlib
import importlib.util
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from itertools import count
from pathlib import Path

import pytest
from stub_programs import WITHIN_S, gone, wait_until

from ddct_bringup.processes import warm_parent
from ddct_bringup.processes.jobs import Job
from ddct_bringup.processes.node_process import Child
from ddct_bringup.processes.warm_parent import WarmParent
from ddct_bringup.run import description
from ddct_bringup.run.description import commit_of
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.domain import own_domain

pytestmark = pytest.mark.slow

Run = Callable[..., Child]
ABOUT_ITSELF = """
import json, os, sys, threading
def main():
    print(json.dumps({
        'pid': os.getpid(),
        'parent': os.getppid(),
        'session': os.getsid(0),
        'arguments': sys.argv[1:],
        'variables': [os.environ.get(name) for name in ('OF_THE_TEST', 'AT_THE_START')],
        'command': open('/proc/self/cmdline').read().split(chr(0)),
        'input': sys.stdin.read(),
        'descriptors': sorted(map(int, os.listdir('/proc/self/fd')))[:-1],
        'threads': len(os.listdir('/proc/self/task')),
    }))
"""


@pytest.fixture
def module(stubs: Path, tmp_path: Path) -> Callable[[str], str]:
    """Return a function that writes a module and returns its name."""

    def write(text: str) -> str:
        name = f'{tmp_path.name}_{len(list(stubs.glob(f"{tmp_path.name}_*.py")))}'
        (stubs / f'{name}.py').write_text(text)
        return name

    return write


@pytest.fixture
def run(parent: WarmParent, module: Callable[[str], str]) -> Run:
    """Return a function that runs a text as a program to its end."""

    def to_its_end(text: str, *arguments: str) -> Child:
        child = Child(module(text), *arguments)
        (child.process,) = parent.start([child.job])
        child.process.wait(WITHIN_S)
        return child

    return to_its_end


def test_what_it_forks_is_a_child_of_ours_with_our_environment_as_it_is_now(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('OF_THE_TEST', 'as \udcff it is')
    child = run(ABOUT_ITSELF, 'a', 'b c')
    report = json.loads(child.output_text())
    assert report['pid'] == report['session'] == child.process.pid
    assert report['parent'] == os.getpid()
    assert report['arguments'] == ['a', 'b c']
    assert report['variables'] == ['as \udcff it is', 'yes']
    assert report['input'] == ''
    assert report['descriptors'] == [0, 1, 2]
    assert child.process.returncode == 0
    monkeypatch.delenv('OF_THE_TEST')
    monkeypatch.delenv('AT_THE_START')
    assert json.loads(run(ABOUT_ITSELF).output_text())['variables'] == [None, None]


def test_ps_shows_a_fork_as_python_with_its_module(run: Run) -> None:
    child = run(ABOUT_ITSELF)
    command = json.loads(child.output_text())['command']
    assert command[:4] == [sys.executable, '-P', '-m', child.job.module]
    assert not any(command[4:])


@pytest.mark.parametrize(
    ('text', 'code', 'last_line'),
    [
        ('def main(): return 0', 0, ''),
        ('def main(): pass', 0, ''),
        ('def main(): return 3', 3, ''),
        ('import sys\ndef main(): sys.exit("no more disk")', 1, 'no more disk'),
        ('import sys\ndef main(): sys.exit()', 0, ''),
        ('import sys\nsys.exit(4)', 4, ''),
        ('def main(): raise ValueError("of the test")', 1, 'ValueError: of the test'),
        ('def main(): raise KeyboardInterrupt', -signal.SIGINT, ''),
        ('import os\ndef main(): os.abort()', -signal.SIGABRT, ''),
        ('import atexit\ndef main(): atexit.register(print, "at the end")', 0, 'at the end'),
        (
            'import threading, time\n'
            'def later(): time.sleep(0.2); print("of a thread")\n'
            'def main(): threading.Thread(target=later).start()',
            0,
            'of a thread',
        ),
    ],
)
def test_a_fork_ends_as_a_program_of_its_own_would(
    run: Run, text: str, code: int, last_line: str
) -> None:
    child = run(text)
    assert child.process.returncode == code
    assert child.last_line() == last_line


def test_nothing_goes_from_one_fork_to_the_next(run: Run) -> None:
    text = (
        'import os, sys, signal\n'
        'import ddct_plant.graph.domain as shared\n'
        'def main():\n'
        '    print(hasattr(shared, "mark"), "MARK" in os.environ, len(sys.path),'
        ' signal.getsignal(signal.SIGINT))\n'
        '    shared.mark = True\n'
        '    os.environ["MARK"] = "yes"\n'
        '    sys.path.append("/nowhere")\n'
        '    signal.signal(signal.SIGINT, signal.SIG_IGN)\n'
    )
    first, second = run(text).output_text(), run(text).output_text()
    assert first == second
    assert first.startswith('False False ')


def test_two_forks_draw_other_random_numbers(run: Run) -> None:
    text = (
        'import random\n'
        'from numpy import random as others\n'
        'def main(): print(random.random(), others.random(), others.default_rng().random())\n'
    )
    first, second = (run(text).output_text().split() for _ in range(2))
    assert all(one != other for one, other in zip(first, second, strict=True))


def test_a_fork_knows_the_commit_of_the_sources_without_git(run: Run) -> None:
    pytest.importorskip('rclpy')
    text = (
        'import os\n'
        'from ddct_bringup.run.description import source_commit\n'
        'def main():\n'
        '    os.environ["PATH"] = "/nowhere"\n'
        '    print(source_commit())\n'
    )
    assert run(text).output_text().strip() == commit_of(Path(description.__file__))


def _threads(pid: int) -> int:
    return len(list(Path(f'/proc/{pid}/task').iterdir()))


def test_it_has_no_thread_but_those_that_ros_brings_along_and_its_forks_have_them_too(
    run: Run, parent: WarmParent
) -> None:
    first = 'import rclpy, ' if importlib.util.find_spec('rclpy') else 'import '
    alone = subprocess.run(
        [sys.executable, '-c', f'{first}os; print(len(os.listdir("/proc/self/task")))'],
        env={**os.environ, 'OPENBLAS_NUM_THREADS': '1'},
        capture_output=True,
        check=True,
        text=True,
    )
    child = run(ABOUT_ITSELF)
    assert _threads(parent.process.pid) == int(alone.stdout)
    assert json.loads(child.output_text())['threads'] == int(alone.stdout)


def test_its_numerics_have_one_thread_unless_the_user_wants_more(
    monkeypatch: pytest.MonkeyPatch, module: Callable[[str], str]
) -> None:
    name = module(
        'import ctypes, pathlib\n'
        'def main():\n'
        '    words = pathlib.Path("/proc/self/maps").read_text().split()\n'
        '    for path in {word for word in words if "openblas" in word}:\n'
        '        for name in ("", "scipy_"):\n'
        '            for end in ("", "64_"):\n'
        '                count = getattr(ctypes.CDLL(path),'
        ' f"{name}openblas_get_num_threads{end}", None)\n'
        '                if count: print(count())\n'
    )
    monkeypatch.delenv('OPENBLAS_NUM_THREADS', raising=False)
    with WarmParent() as parent:
        child = Child(name)
        (child.process,) = parent.start([child.job])
        child.process.wait(WITHIN_S)
    assert set(child.output_text().split()) == {'1'}


def test_a_parent_started_ahead_is_returned_to_the_first_caller_and_closed_at_the_end() -> None:
    with warm_parent.started_ahead():
        (ahead,) = warm_parent._ahead
        with warm_parent.warm_parent() as first, warm_parent.warm_parent() as second:
            assert first is ahead
            assert second is not ahead
            assert not warm_parent._ahead
    with warm_parent.started_ahead():
        (unused,) = warm_parent._ahead
    assert unused.process.returncode == -signal.SIGKILL
    assert not warm_parent._ahead


def test_a_parent_that_was_killed_since_the_last_start_is_replaced(run: Run, parent: WarmParent):
    run('def main(): pass')
    parent.process.kill()
    parent.process.wait()
    assert json.loads(run(ABOUT_ITSELF).output_text())['parent'] == os.getpid()


def test_a_parent_that_is_killed_while_it_should_fork_is_named() -> None:
    with WarmParent() as parent:
        parent.process.send_signal(signal.SIGSTOP)
        waited = count()

        def stopped() -> bool:
            if next(waited) == 2:
                parent.process.kill()
            return False

        with pytest.raises(DdctError, match='cannot be started: the warm parent, which forks the'):
            parent.start([Job('ddct_bringup.processes.guardian')], stopped=stopped)


def test_a_parent_that_cannot_import_is_reported_with_the_reason(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    (tmp_path / 'json.py').write_text('raise ImportError("of the test")')
    monkeypatch.setenv('PYTHONPATH', str(tmp_path), prepend=':')
    with WarmParent() as parent, pytest.raises(DdctError, match='ImportError: of the test$'):
        parent.start([Job('ddct_bringup.processes.guardian')])


def test_a_parent_that_hangs_is_not_waited_for_without_end(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(warm_parent, 'START_S', 0.2)
    with WarmParent() as parent:
        parent.process.send_signal(signal.SIGSTOP)
        with pytest.raises(DdctError, match=r'could not be started within 0\.2 s'):
            parent.start([Job('ddct_bringup.processes.guardian')])
    assert parent.process.returncode == -signal.SIGKILL


def _children() -> set[int]:
    """Return the ids of the child processes of this one, zombies included."""
    found = set()
    for stat in Path('/proc').glob('[0-9]*/stat'):
        with contextlib.suppress(OSError):  # it may end during the scan
            _, parent = stat.read_text().rpartition(')')[2].split()[:2]
            if int(parent) == os.getpid():
                found.add(int(stat.parent.name))
    return found


@pytest.mark.parametrize('method', ['_wait_for_forks', '_forked'])
def test_no_fork_is_left_behind_a_failed_start(
    monkeypatch: pytest.MonkeyPatch, module: Callable[[str], str], method: str
) -> None:
    children = [Child(module('def main(): return 7')) for _ in range(3)]
    before = _children()
    original = getattr(WarmParent, method)

    def fail(*arguments: object) -> None:
        original(*arguments)
        raise KeyboardInterrupt

    with WarmParent() as parent:
        with monkeypatch.context() as failing, pytest.raises(KeyboardInterrupt):
            failing.setattr(WarmParent, method, fail)
            parent.start([child.job for child in children])
        assert _children() == before
        (process, *_) = parent.start([child.job for child in children])
        assert process.wait(WITHIN_S) == 7


def test_a_late_reply_of_the_parent_is_not_taken_for_the_reply_to_the_next_request(
    monkeypatch: pytest.MonkeyPatch, module: Callable[[str], str]
) -> None:
    child = Child(module('def main(): return 7'))
    with WarmParent() as parent:
        stopped = parent.process.pid
        os.kill(stopped, signal.SIGSTOP)
        monkeypatch.setattr(warm_parent, 'START_S', 0.2)
        with pytest.raises(DdctError):
            parent.start([child.job])
        monkeypatch.setattr(warm_parent, 'START_S', WITHIN_S)
        if not gone(stopped):
            os.kill(stopped, signal.SIGCONT)
        (process,) = parent.start([child.job])
        assert process.wait(WITHIN_S) == 7


def test_ctrl_c_while_it_imports_ends_it_at_once() -> None:
    with WarmParent() as parent:
        parent.process.send_signal(signal.SIGSTOP)
        with pytest.raises(KeyboardInterrupt):
            parent.start([Job('ddct_bringup.processes.guardian')], stopped=lambda: True)
        assert parent.process.returncode == -signal.SIGKILL


def test_no_fork_begins_before_all_are_registered_for_supervision(
    parent: WarmParent, module: Callable[[str], str], tmp_path: Path
) -> None:
    name = module(f'import pathlib\npathlib.Path({str(tmp_path / "began")!r}).touch()\n')
    known: list[int] = []

    def watch(pid: int) -> None:
        known.append(pid)
        if len(known) == 2:
            raise OSError('of the test')

    with pytest.raises(OSError, match='of the test'):
        parent.start([Job(name), Job(name)], watch)
    assert len(known) == 2
    assert not any(Path(f'/proc/{pid}').exists() for pid in known), 'ended, and waited for'
    assert not (tmp_path / 'began').exists()


def test_the_forks_of_a_supervisor_that_is_killed_meanwhile_never_begin(
    module: Callable[[str], str], tmp_path: Path
) -> None:
    name = module(f'import pathlib\npathlib.Path({str(tmp_path / "began")!r}).touch()\n')
    text = (
        'import os, signal\n'
        'from ddct_bringup.processes.jobs import Job\n'
        'from ddct_bringup.processes.warm_parent import WarmParent\n'
        'def watch(pid):\n'
        '    print(parent.process.pid, pid, flush=True)\n'
        '    os.kill(os.getpid(), signal.SIGKILL)\n'
        'parent = WarmParent()\n'
        f'parent.start([Job({name!r})], watch)\n'
    )
    done = subprocess.run([sys.executable, '-c', text], stdout=subprocess.PIPE, check=False)
    assert done.returncode == -signal.SIGKILL
    pids = [int(pid) for pid in done.stdout.split()]
    assert len(pids) == 2
    wait_until(lambda: all(gone(pid) for pid in pids))
    assert not (tmp_path / 'began').exists()


def test_we_take_no_orphans_but_those(run: Run) -> None:
    run('def main(): pass')
    orphan = subprocess.run(
        ['sh', '-c', '(sleep 0.3; echo $PPID > /dev/null; exec cat /proc/self/stat) & exit 0'],
        stdout=subprocess.PIPE,
        check=True,
    )
    parent_of_orphan = int(orphan.stdout.rpartition(b')')[2].split()[1])
    assert parent_of_orphan != os.getpid()


def test_a_node_imports_no_generator_of_messages_and_can_import_all_of_it(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip('rclpy')
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    with own_domain():
        child = run(
            'import sys, rclpy\n'
            'def main():\n'
            '    rclpy.init()\n'
            '    rclpy.create_node("alone").destroy_node()\n'
            '    print({"em", "lark", "rosidl_generator_py"} & set(sys.modules))\n'
            '    rclpy.shutdown()\n'
            '    from rosidl_generator_py import generate_py\n'
            '    print(generate_py.__name__)\n'
        )
    assert child.output_text().splitlines() == ['set()', 'generate_py']
