# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Forks of the fork server are like new processes."""

import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest
from stub_programs import SMALL_SERVER, Start, gone
from waiting import WITHIN_S, wait_until

from ddct_bringup.processes import fork_server
from ddct_bringup.processes.fork_server import server_pid, start_processes, stop_server
from ddct_bringup.processes.forked import Forked
from ddct_plant.base.errors import DdctError
from ddct_plant.program.supervision import Patience

pytestmark = [pytest.mark.process, pytest.mark.usefixtures('small_server')]

ABOUT_ITSELF = """
import json, os, signal, sys, threading
def main():
    print(json.dumps({
        'pid': os.getpid(),
        'group': os.getpgrp(),
        'arguments': sys.argv[1:],
        'variables': [os.environ.get(name) for name in ('OF_THE_TEST', 'DDCT_FORK_SERVER')],
        'input': sys.stdin.read(),
        'folder': os.getcwd(),
        'path': sys.path,
        'comm': open('/proc/self/comm').read().strip(),
        'streams': [os.readlink(f'/proc/self/fd/{each}') for each in (1, 2)],
        'blocked': [*map(int, signal.pthread_sigmask(signal.SIG_BLOCK, ()))],
    }))
"""


def test_a_fork_has_our_environment_as_it_is_now_and_nothing_else_of_ours(
    run: Start, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv('OF_THE_TEST', 'as \udcff it is')
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, 'path', ['', str(tmp_path), *sys.path])
    forked = run(ABOUT_ITSELF, 'a', 'b c')
    report = json.loads(forked.printed())
    assert forked.code() == 0
    assert report['pid'] == forked.pid
    assert report['group'] == server_pid() != os.getpgrp(), 'Ctrl-C reaches the program alone'
    assert report['arguments'] == ['a', 'b c']
    assert report['variables'] == ['as \udcff it is', None]
    assert report['input'] == ''
    assert report['folder'] == str(tmp_path)
    assert not {'', str(tmp_path)} & set(report['path']), 'a file here hides no module'
    assert report['comm'] == forked.process.name[:15]
    assert report['streams'][0] == report['streams'][1]
    assert report['blocked'] == []
    monkeypatch.delenv('OF_THE_TEST')
    assert json.loads(run(ABOUT_ITSELF).printed())['variables'] == [None, None]


@pytest.mark.parametrize(
    ('text', 'code', 'last_line'),
    [
        ('def main(): return 0', 0, ''),
        ('def main(): pass', 0, ''),
        ('def main(): return 3', 3, ''),
        ('import sys\ndef main(): sys.exit("no more disk")', 1, 'no more disk'),
        ('def main(): raise ValueError("of the test")', 1, 'ValueError: of the test'),
        ('import os\ndef main(): os.abort()', -signal.SIGABRT, ''),
        ('import os\ndef main(): os._exit(255)', 255, ''),
        ('import atexit\ndef main(): atexit.register(print, "at the end")', 0, 'at the end'),
    ],
)
def test_a_fork_ends_as_a_program_of_its_own_would(
    run: Start, text: str, code: int, last_line: str
) -> None:
    forked = run(text)
    assert forked.code() == code
    assert ['', *forked.lines()][-1] == last_line


HANGS = {
    'without the lock of the interpreter': 'time.sleep(600)',
    'with the lock of the interpreter': 'sum(range(10**15))',
}
HANGING = (
    'import time\nfrom ddct_plant.program.supervision import beat\n'
    'def hang():\n    beat()\n    {}\n'
    'def main():\n    hang()\n'
)


@pytest.mark.parametrize('work', HANGS.values(), ids=HANGS)
def test_a_node_that_hangs_ends_itself_and_prints_where(start: Start, work: str) -> None:
    forked = start(HANGING.format(work), patience=Patience(silent_s=0.1))
    assert forked.wait(WITHIN_S)
    assert forked.code() == 1
    first, *stacks = forked.lines()
    assert first.startswith('Timeout (')
    assert any('in hang' in line for line in stacks)


def test_a_node_that_never_begins_ends_itself_too(start: Start) -> None:
    forked = start('import time\ndef main(): time.sleep(600)\n', patience=Patience(start_s=0.1))
    assert forked.wait(WITHIN_S)
    assert forked.code() == 1


LEAVING = (
    'import signal, time\nfrom ddct_plant.program.supervision import announce_exit\n'
    'def main():\n'
    '    signal.signal(signal.SIGALRM, signal.SIG_IGN)\n'
    "    print('clutch: no more disk', flush=True)\n"
    '    announce_exit({code})\n'
    '    time.sleep(600)\n'
)


@pytest.mark.parametrize('code', [0, 1])
def test_a_node_that_hangs_while_it_leaves_is_ended_and_its_announced_code_counts(
    start: Start, code: int
) -> None:
    """Fast DDS may hang while a node leaves."""
    forked = start(LEAVING.format(code=code), patience=Patience(leave_s=0.1))
    assert forked.wait(WITHIN_S)
    assert (forked.code(), forked.lines()) == (code, ['clutch: no more disk'])


def test_a_node_that_dies_otherwise_while_it_leaves_has_not_ended_well(start: Start) -> None:
    text = LEAVING.format(code=0).replace('time.sleep(600)', 'signal.raise_signal(11)')
    forked = start(text, patience=Patience())
    assert forked.wait(WITHIN_S)
    assert forked.code() == -signal.SIGSEGV


@pytest.mark.parametrize('announced', [0, None])
def test_without_its_fork_server_the_announced_code_of_a_node_is_known_and_no_other(
    start: Start, tmp_path: Path, announced: int | None
) -> None:
    go_on = tmp_path / 'go_on'
    text = (
        'import pathlib, time\nfrom ddct_plant.program.supervision import announce_exit\n'
        f'def main():\n    while not pathlib.Path({str(go_on)!r}).exists(): time.sleep(0.01)\n'
    )
    text += '    announce_exit(0)\n' if announced == 0 else '    raise SystemExit(1)\n'
    forked = start(text, patience=Patience())
    stop_server()
    assert forked.running, 'it goes on'
    go_on.touch()
    assert forked.wait(WITHIN_S)
    assert forked.code() == announced


def test_a_server_that_was_killed_since_the_last_start_is_replaced(run: Start) -> None:
    run('def main(): pass')
    before = server_pid()
    stop_server()
    assert server_pid() == 0
    assert json.loads(run(ABOUT_ITSELF).printed())['group'] == server_pid() != before


def _paused_server(start: Start) -> int:
    start('def main(): pass')
    pid = server_pid()
    os.kill(pid, signal.SIGSTOP)
    return pid


def test_a_server_that_hangs_is_not_waited_for_without_end(
    start: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    paused = _paused_server(start)
    monkeypatch.setattr(fork_server, 'START_S', 0.2)
    with pytest.raises(DdctError, match=r'could not be started within 0\.2 s'):
        start('def main(): pass')
    assert gone(paused)
    monkeypatch.undo()
    assert server_pid() == 0


def test_ctrl_c_while_it_imports_ends_it_at_once(
    start: Start, module: Callable[[str], str]
) -> None:
    paused = _paused_server(start)
    forked = Forked(module('def main(): pass'))
    with pytest.raises(KeyboardInterrupt):
        start_processes([forked.process], stopped=lambda: True)
    assert gone(paused)
    forked.close()


def test_a_server_that_is_killed_while_it_should_fork_is_named(
    start: Start, module: Callable[[str], str]
) -> None:
    paused = _paused_server(start)
    forked = Forked(module('def main(): pass'))

    def stopped() -> bool:
        if not gone(paused):
            os.kill(paused, signal.SIGKILL)
        return False

    with pytest.raises(DdctError, match='cannot be started: the fork server, which forks them, w'):
        start_processes([forked.process], stopped)
    forked.close()


def test_a_folder_for_temporary_files_with_a_long_name_is_reported(
    tmp_path: Path,
) -> None:
    folder = tmp_path / ('long' * 30)
    folder.mkdir()
    text = 'from ddct_bringup.processes.fork_server import start_server; start_server()'
    done = subprocess.run(
        [sys.executable, '-c', text],
        env={**os.environ, 'TMPDIR': str(folder)},
        capture_output=True,
        text=True,
    )
    assert done.stderr.splitlines()[-1].endswith('set TMPDIR to a folder with a shorter name')


def test_ctrl_c_in_a_terminal_does_not_reach_the_server_while_it_starts() -> None:
    text = (
        f'{SMALL_SERVER}import os, signal\n'
        'from multiprocessing import util\n'
        'from ddct_bringup.processes.fork_server import CONTEXT, start_server\n'
        'started = util.spawnv_passfds\n'
        'def spawn(path, arguments, fds):\n'
        '    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, ())\n'
        '    print("forkserver" in str(arguments), signal.SIGINT in blocked)\n'
        '    pid = started(path, arguments, fds)\n'
        '    os.kill(pid, signal.SIGINT)\n'
        '    return pid\n'
        'util.spawnv_passfds = spawn\n'
        'start_server()\n'
        'print(signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, ()))\n'
        'forked = CONTEXT.Process(target=int)\n'
        'forked.start()\n'
        'forked.join()\n'
        'print(forked.exitcode)\n'
    )
    done = subprocess.run([sys.executable, '-c', text], capture_output=True, text=True)
    assert done.stderr == ''
    *_, server, afterwards, code = done.stdout.splitlines()
    assert (server, afterwards, code) == ('True True', 'False', '0')


def _temporary(tmp_path: Path) -> dict[str, str]:
    """Return the environment of a program with an empty folder `t` for temporary files."""
    folder = Path(tempfile.mkdtemp(prefix='ddct-'))
    (tmp_path / 't').symlink_to(folder)
    return {**os.environ, 'TMPDIR': str(folder)}


def _nothing_left(tmp_path: Path) -> bool:
    return not [*(tmp_path / 't').iterdir()]


def test_a_program_that_is_killed_while_its_server_imports_leaves_nothing(tmp_path: Path) -> None:
    text = (
        'import os\nfrom ddct_bringup.processes.fork_server import start_server\n'
        'start_server()\nos.kill(os.getpid(), 9)\n'
    )
    subprocess.run([sys.executable, '-c', text], env=_temporary(tmp_path), check=False)
    wait_until(lambda: _nothing_left(tmp_path), 'an empty folder')


def test_a_program_that_is_killed_after_its_server_leaves_nothing(
    module: Callable[[str], str], tmp_path: Path
) -> None:
    program = subprocess.Popen(
        [
            sys.executable,
            '-c',
            PROGRAM,
            str(tmp_path / 'path'),
            module(FINISHING.format(whole='/dev/null')),
        ],
        stdout=subprocess.PIPE,
        env=_temporary(tmp_path),
        start_new_session=True,
    )
    assert program.stdout
    server, node = map(int, program.stdout.readline().split())
    os.kill(server, signal.SIGKILL)
    program.kill()
    program.communicate()
    wait_until(lambda: gone(node) and _nothing_left(tmp_path), 'the end')


PROGRAM = f"""{SMALL_SERVER}
import os, sys, time
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from ddct_bringup.processes.fork_server import server_pid, start_processes
from ddct_bringup.processes.forked import Forked
nodes = [Forked(name) for name in sys.argv[2:]]
start_processes([node.process for node in nodes])
for node in nodes:
    node.begin()
while not all('ready' in node.printed_text() for node in nodes):
    time.sleep(0.01)
print(server_pid(), *(node.pid for node in nodes), flush=True)
time.sleep(600)
"""
FINISHING = """
import pathlib, signal, sys, time
def finish(*_):
    pathlib.Path({whole!r}).touch()
    sys.exit(0)
def main():
    signal.signal(signal.SIGTERM, finish)
    print('ready', flush=True)
    while True:  # as a node does: a signal just before a sleep does not interrupt it
        time.sleep(0.1)
"""
DEAF = """
import signal, time
def main():
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    print('ready', flush=True)
    while True:
        time.sleep(600)
"""


@pytest.mark.parametrize('paused', ['nobody', 'one', 'all'])
def test_after_a_killed_program_every_node_ends_even_a_paused_one(
    module: Callable[[str], str], tmp_path: Path, paused: str
) -> None:
    """The fork server removes the socket of the program too."""
    whole = tmp_path / 'whole'
    names = [
        module(FINISHING.format(whole=str(whole))),
        module(FINISHING.format(whole='/dev/null')),
    ]
    program = subprocess.Popen(
        [sys.executable, '-c', PROGRAM, str(tmp_path / 'path'), *names],
        stdout=subprocess.PIPE,
        env=_temporary(tmp_path),
        start_new_session=True,
    )
    assert program.stdout
    server, *nodes = map(int, program.stdout.readline().split())
    for pid in {'nobody': [], 'one': nodes[:1], 'all': nodes}[paused]:
        os.kill(pid, signal.SIGSTOP)
    program.kill()
    program.communicate()
    wait_until(lambda: all(map(gone, [server, *nodes])), 'the end of all')
    assert whole.exists(), 'the recorder could not finish'
    assert _nothing_left(tmp_path)


def test_a_node_that_ignores_the_end_of_its_program_is_ended(
    module: Callable[[str], str], tmp_path: Path
) -> None:
    sooner = 'from ddct_bringup.processes import forked\nforked.ORPHANED_S = 0.2\n'
    program = subprocess.Popen(
        [sys.executable, '-c', PROGRAM, str(tmp_path / 'path'), module(sooner + DEAF)],
        stdout=subprocess.PIPE,
        start_new_session=True,
    )
    assert program.stdout
    pids = [*map(int, program.stdout.readline().split())]
    program.kill()
    program.communicate()
    wait_until(lambda: all(map(gone, pids)), 'the end of all')
