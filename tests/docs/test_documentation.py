"""Every command in the documentation runs, every link leads somewhere, every page is found."""

import os
import re
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from support.documented import PAGES, ROOT, Block, blocks, links

from ddct_bringup import compare

NOT_RUN_HERE = {
    'make': 'would run this very test, or take its environment away; .ci/run and users run them',
    'sudo': "needs Ubuntu with apt's ROS 2",
    'rosdep': "needs apt's ROS 2",
    'colcon': 'make setup has run it',
    '. /opt/ros': "needs apt's ROS 2",
    'ros2 param': 'the ROS 2 wheels bring no ros2 command; tests/graph sets gains by the service',
    'ros2 topic': 'the ROS 2 wheels bring no ros2 command',
    'python -m pip': 'would change the environment of the tests',
    'ros2 run ddct_bringup bringup --mode realtime --controller ls8 --live': (
        'waits for a viewer; tests/live gives it one'
    ),
    'ros2 run ddct_bringup live': 'serves until Ctrl-C; tests/live stops it',
    'ros2 run ddct_bringup calibrate': 'takes minutes; ddct_bringup/test runs it with --quick',
}
"""First words of commands and why no test runs them."""
ONCE = 'ros2 run ddct_controllers design'
"""Commands that take long and leave nothing that a later one reads: repeated ones run once."""
WITHIN_S = 240.0
CLICKS = 3
SHELL_BLOCKS = [block for block in blocks() if block.is_shell]
DONE: set[str] = set()

ROS2 = """\
#!{shell}
# ros2 run PACKAGE PROGRAM ARGUMENTS..., faster where another test runs the real thing.
[ "$1" = run ] || exit 2
package=$2 program=$3; shift 3
case "$program $*" in
    *--help*|*--list*|*--headless*|*--single-process*|*realtime*) ;;
    bringup*|compare*) set -- "$@" --headless ;;
esac
[ "$package" = my_actuator ] && package=ddct_plant program=actuator
exec "{install}/$package/lib/$package/$program" "$@"
"""


def runnable(line: str) -> bool:
    return not any(line.startswith(words) for words in NOT_RUN_HERE)


def label(block: Block) -> str:
    first = next((line for line in block.lines if runnable(line)), block.lines[0])
    return f'{block.page}: {first[:60]}'


def install_example(site: Path) -> None:
    """Make the package of docs/writing_a_controller.md out of the code that the page shows."""
    code = next(
        block.text
        for block in blocks()
        if block.page == 'docs/writing_a_controller.md' and block.language == 'python'
    )
    package, record = site / 'my_package', site / 'my_package-1.0.dist-info'
    for folder in (package, record):
        folder.mkdir(parents=True)
    (package / '__init__.py').touch()
    (package / 'control.py').write_text(code)
    (record / 'METADATA').write_text('Metadata-Version: 2.1\nName: my_package\nVersion: 1.0\n')
    (record / 'entry_points.txt').write_text(
        '[ddct.controllers]\nproportional = my_package.control:make_proportional\n'
    )


@pytest.fixture
def workplace(tmp_path: Path) -> Path:
    """Return a folder with what commands read and write, and a `ros2` that finds our programs."""
    install = next(
        (Path(entry) for entry in os.environ.get('COLCON_PREFIX_PATH', '').split(':') if entry),
        ROOT / 'install',
    )
    if not (install / 'setup.bash').exists():
        pytest.skip('the workspace is not built: make setup')
    shutil.copytree(ROOT / 'docs', tmp_path / 'docs')
    scenarios = Path('ddct_plant') / 'ddct_plant' / 'scenarios'
    shutil.copytree(ROOT / scenarios, tmp_path / scenarios)
    (tmp_path / 'install').symlink_to(install)
    install_example(tmp_path / 'site')
    ros2 = tmp_path / 'bin' / 'ros2'
    ros2.parent.mkdir()
    ros2.write_text(ROS2.format(shell=shutil.which('bash'), install=install))
    ros2.chmod(ros2.stat().st_mode | stat.S_IXUSR)
    return tmp_path


@pytest.mark.parametrize('block', SHELL_BLOCKS, ids=label)
def test_commands_run(block, workplace):
    commands = [line for line in block.lines if runnable(line)]
    if commands and all(line in DONE for line in commands):
        pytest.skip('run already, with another page')
    commands = [line for line in commands if line not in DONE]
    if not commands:
        pytest.skip(
            next(why for words, why in NOT_RUN_HERE.items() if block.text.startswith(words))
        )
    # Background nodes end with the script.
    script = '\n'.join(
        ['set -e', "trap 'kill $(jobs -p) 2>/dev/null || true; wait' EXIT", *commands]
    )
    environment = {
        **os.environ,
        'PATH': f'{workplace / "bin"}:{os.environ["PATH"]}',
        'PYTHONPATH': f'{workplace / "site"}:{os.environ.get("PYTHONPATH", "")}',
    }
    done = subprocess.run(
        [shutil.which('bash') or 'bash', '-c', script],
        cwd=workplace,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=False,
    )
    assert done.returncode == 0, f'{script}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}'
    DONE.update(line for line in commands if line.startswith(ONCE))


def test_commands_say_where_their_program_is():
    """A bare program name works in no shell, and would slip through the test above."""
    names = {'bringup', 'compare', 'score', 'report', 'live', 'calibrate', 'design', 'identify'}
    bare = [
        (block.page, line)
        for block in blocks()
        for line in block.lines
        if line.split()[0] in names and block.language == ''
    ]
    assert bare == []


def test_there_are_commands_to_run():
    assert len(SHELL_BLOCKS) > 15
    assert {block.page for block in SHELL_BLOCKS} >= {'README.md', 'docs/mpc.md'}


@pytest.mark.parametrize('page', ['README.md', 'docs/writing_a_controller.md'])
def test_python_examples_run(page, tmp_path):
    """One after the other, as one reads them."""
    parts = [block.text for block in blocks() if block.page == page and block.language == 'python']
    assert parts
    code = '\n'.join(parts)
    done = subprocess.run(
        [sys.executable, '-c', code],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_links_lead_to_files(page):
    assert [str(target) for target in links(page) if not target.exists()] == []


def test_every_page_is_three_clicks_from_the_top():
    found = {PAGES[0]}
    for _ in range(CLICKS):
        found |= {target for page in found if page.suffix == '.md' for target in links(page)}
    assert [str(page) for page in PAGES if page not in found] == []


def test_the_table_of_the_readme_is_what_make_demo_prints(tmp_path, capsys):
    """All but the line that rich draws as wide as its table."""
    makefile = (ROOT / 'Makefile').read_text(encoding='utf-8')
    (names,) = re.findall(r'compare \\\n\s+--controllers (\S+) --out runs/demo', makefile)
    assert compare.main(['--controllers', names, '--headless', '--out', str(tmp_path / 'x')]) == 0
    printed = {' '.join(line.split()) for line in capsys.readouterr().out.splitlines()}
    (table,) = [block for block in blocks() if block.page == 'README.md' and 't_a' in block.text]
    shown = [line for line in table.lines if '─' not in line]
    assert len(shown) == 2 + len(names.split(','))
    assert [line for line in shown if line not in printed] == []
