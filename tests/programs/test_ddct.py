# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`ddct` starts every program by its name, and lists them."""

import os
import re
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from support.complaints import assert_one_line
from support.processes import Programs, processes_left
from waiting import WITHIN_S, wait_until

from ddct_bringup import processes
from ddct_bringup.programs import ddct, node
from ddct_plant.program import command_line
from ddct_plant.program.command_line import programs, scripts

ROOT = Path(__file__).resolve().parents[2]


GROUPS = ('ddct.programs', 'ddct.scripts')


def install_program(site: Path, code: str) -> None:
    """Install the program `extra` of a third party into a folder of Python's path."""
    record = site / 'extra-1.0.dist-info'
    record.mkdir()
    (site / 'extra_program.py').write_text(code)
    (record / 'METADATA').write_text('Metadata-Version: 2.1\nName: extra\nVersion: 1.0\n')
    points = ''.join(f'[{each}]\nextra = extra_program:main\n' for each in GROUPS)
    (record / 'entry_points.txt').write_text(points)


def help_text(capsys: pytest.CaptureFixture[str]) -> str:
    with pytest.raises(SystemExit) as end:
        ddct.main(['--help'])
    assert not end.value.code
    return capsys.readouterr().out


def test_help_lists_every_program_by_task_in_80_columns(
    capsys: pytest.CaptureFixture[str],
) -> None:
    text = help_text(capsys)
    listed = [name for names in ddct.TASKS.values() for name in names]
    assert sorted(listed) == sorted(programs())
    found = re.findall(r'^(  (\w+)  +)(\w.*)', text.partition('positional')[0], re.MULTILINE)
    assert [name for _, name, _ in found] == listed
    assert len({len(before) for before, _, _ in found}) == 1
    for _, name, task in found:
        assert len(task.split()) >= 4 and 'cannot be read' not in task, name
    assert max(map(len, text.splitlines())) <= 80


def test_node_starts_the_nodes_alone(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, 'argv', ['ddct', 'node', 'load', '--help'])
    assert ddct.main() == 0
    assert 'usage: ddct node load ' in capsys.readouterr().out
    assert set(node.node_names()) == set(scripts()) - {'bringup', 'live', 'score'}
    with pytest.raises(SystemExit):
        node.main(['loda'])
    assert capsys.readouterr().err == (
        'ddct node: unknown node loda: did you mean load? See ddct node --help\n'
    )


def test_programs_start_without_the_slow_parts_of_scipy() -> None:
    """Scipy is imported when something is computed: --help and errors need not wait for it."""
    names = (
        'campaign',
        'compare',
        'identify',
        'limit',
        'live',
        'report',
        'score',
        'sweep',
    )
    known = programs()
    modules = [known[name].module for name in names]
    code = (
        f'import {", ".join(modules)}, sys; print([n for n in sys.modules if n[:6] == "scipy."])'
    )
    loaded = subprocess.run(
        [sys.executable, '-P', '-c', code], capture_output=True, text=True, check=True
    ).stdout
    slow = ('signal', 'stats', 'optimize', 'integrate', 'interpolate', 'linalg', 'special')
    assert 'scipy._lib' in loaded
    assert [name for name in slow if f"'scipy.{name}" in loaded] == []


@pytest.mark.parametrize(
    ('arguments', 'line'),
    [
        (['comparee'], 'unknown program comparee: did you mean compare? See'),
        (
            ['driveline'],
            'unknown program driveline: to start this node give ddct node driveline: see',
        ),
        ([], 'the following arguments are required: PROGRAM: see'),
        (['--nothing'], 'the following arguments are required: PROGRAM: see'),
    ],
)
def test_an_unknown_program_is_one_line(
    arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        ddct.main(arguments)
    assert end.value.code == 2
    assert capsys.readouterr().err == f'ddct: {line} ddct --help\n'


@pytest.mark.parametrize(
    ('arguments', 'line'),
    [
        (
            ['thesis', 'number'],
            'ddct thesis: unknown subcommand number: did you mean numbers? See ddct thesis --help',
        ),
        (
            ['design', 'plant', '--nothing'],
            'ddct design plant: unrecognized arguments: --nothing: see ddct design plant --help',
        ),
    ],
)
def test_a_mistake_in_a_subcommand_is_one_line(
    arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        ddct.main(arguments)
    assert end.value.code == 2
    assert capsys.readouterr().err == f'{line}\n'


def test_it_passes_on_the_arguments_and_the_exit_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    code = '"""Do more."""\nimport sys\n\ndef main():\n    print(sys.argv[1:])\n    return 7\n'
    install_program(tmp_path, code)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, 'argv', ['ddct', 'extra', '--help', '-x', '1'])
    assert ddct.main() == 7
    assert capsys.readouterr().out == "['--help', '-x', '1']\n"
    assert re.search(r'^  extra +Do more\.$', help_text(capsys), re.MULTILINE)


def test_a_program_that_cannot_be_imported_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    install_program(tmp_path, 'import nowhere\n')
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, 'extra_program', raising=False)
    assert ddct.main(['extra']) == 1
    error = capsys.readouterr().err
    assert error == "ddct: extra cannot start: No module named 'nowhere': install what it needs\n"


@pytest.mark.parametrize('after', ["raise ImportError('no module')", 'def main(): return 0'])
@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_during_imports_is_no_missing_package(
    after: str,
    number: signal.Signals,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Modules in C report an interruption as a failed import, or drop it."""
    code = f'import os\ntry:\n    os.kill(os.getpid(), {number:d})\nexcept BaseException: pass\n'
    install_program(tmp_path, f'{code}{after}\n')
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, 'extra_program', raising=False)
    assert ddct.main(['extra']) == 128 + number
    assert capsys.readouterr().err == 'ddct: interrupted\n'


@pytest.mark.parametrize('script', ['ddct', 'extra'])
@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(
    'code',
    [
        'class Signals:\n    def __set_name__(self, owner, name):\n        interrupt()\n\n\n'
        'class Owner:\n    key = Signals()\n',
        'try:\n    interrupt()\nexcept BaseException:\n    raise ValueError("failed")\n',
        'try:\n    interrupt()\nexcept BaseException as e:\n    raise ImportError("no") from e\n',
        'try:\n    interrupt()\nexcept BaseException:\n    pass\nraise SystemError("null")\n',
    ],
    ids=['wrapped by Python', 'another error', 'cause of a failed import', 'dropped in C'],
)
def test_a_signal_during_imports_ends_a_program_as_any_other(
    code: str,
    number: signal.Signals,
    script: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    interrupt = f'import os\n\n\ndef interrupt():\n    os.kill(os.getpid(), {number:d})\n\n\n'
    install_program(tmp_path, f'{interrupt}{code}\n\ndef main():\n    return 0\n')
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, 'extra_program', raising=False)
    monkeypatch.setattr(sys, 'argv', [f'/lib/{script}', 'extra'])
    assert (ddct if script == 'ddct' else command_line).main() == 128 + number
    assert capsys.readouterr().err == f'{script}: interrupted\n'


@pytest.mark.parametrize('name', ['rclpy', 'rcl_interfaces'])
def test_a_node_without_ros_names_what_is_missing_and_the_page_to_read(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    install_program(tmp_path, f'import {name}\n')
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, 'extra_program', raising=False)
    for missing in ('rclpy', 'rcl_interfaces'):
        monkeypatch.setitem(sys.modules, missing, None)
    assert ddct.main(['extra']) == 1
    assert capsys.readouterr().err == (
        'ddct: the graph and its nodes need ROS 2, and its package rclpy is not installed: '
        'run headless, or set ROS up as docs/use/setup.md tells, from wheels on x86-64 Linux or '
        'from apt on Ubuntu 24.04\n'
    )


def test_a_graph_without_ros_is_refused_by_the_program_that_runs_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr('importlib.util.find_spec', lambda name: None)
    assert ddct.main(['compare', '--controllers', 'pi', '--out', 'runs']) == 1
    assert capsys.readouterr().err.startswith('ddct compare: the graph and its nodes need ROS 2')


def test_it_imports_nothing_heavy_itself() -> None:
    code = (
        'import sys; from ddct_bringup.programs.ddct import main\n'
        'try: main(["--help"])\n'
        'except SystemExit: print(sorted({"numpy", "rclpy", "scipy", "yaml"} & set(sys.modules)))'
    )
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, timeout=WITHIN_S, check=True
    )
    assert done.stdout.splitlines()[-1] == '[]'


def test_a_sourced_workspace_has_it_on_the_path() -> None:
    prefix = Path(os.environ.get('COLCON_PREFIX_PATH', '').split(':')[0] or ROOT / 'install')
    if not (prefix / 'setup.bash').exists():
        pytest.skip('the workspace is not built: make setup')
    done = subprocess.run(
        ['bash', '-c', f'. {prefix}/setup.bash; command -v ddct; cd /; ddct node load --help'],
        env={'PATH': os.defpath, 'HOME': os.environ.get('HOME', '/')},
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[0].endswith('/bin/ddct')
    assert 'usage: ddct node load ' in done.stdout


@pytest.mark.parametrize(
    ('arguments', 'expected'),
    [
        (['compare', '--controllers', 'pi'], 1),
        (['compare', '--headless'], 0),
        (['compare', '--list'], 0),
        (['compare', '--help'], 0),
        (['score', '--help'], 0),
    ],
)
def test_the_fork_server_starts_ahead_where_nodes_are_to_come(
    arguments: list[str], expected: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[bool] = []
    monkeypatch.setattr(processes, 'start_server', lambda: started.append(True))
    monkeypatch.setattr(sys, 'argv', ['ddct'])
    with suppress(SystemExit):
        ddct.main(arguments)
    assert len(started) == expected


def test_a_fork_server_started_in_vain_ends_with_its_program(programs: Programs) -> None:
    start = 'from ddct_bringup.programs.ddct import main; raise SystemExit(main())'
    program = programs.start([sys.executable, '-P', '-c', start, 'compare'])
    assert program.wait() == 1
    assert_one_line(program.errors(), 'ddct compare', '--out is missing')
    assert not any('forkserver' in command for command in processes_left().values())
    wait_until(lambda: not processes_left(), 'the end of the git that the server has asked', 20.0)
