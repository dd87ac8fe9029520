# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The tiers are kept apart: `make test-fast` fails a test of another, none runs a nightly one."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

pytestmark = pytest.mark.process

ROOT = Path(__file__).parents[2]
Run = Callable[..., str]


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Return a function that runs tests in a project with the plugin, and returns its output."""
    (tmp_path / 'pyproject.toml').write_text(
        '[tool.pytest.ini_options]\nmarkers = ["slow"]\naddopts = "-p tiers -p no:cacheprovider"\n'
    )

    def carry_out(texts: dict[str, str], *options: str) -> str:
        for name, text in texts.items():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(text)
        done = subprocess.run(
            [sys.executable, '-m', 'pytest', '-q', *options],
            cwd=tmp_path,
            env={**os.environ, 'PYTHONPATH': str(ROOT / 'tests' / 'plugins')},
            capture_output=True,
            text=True,
            check=False,
        )
        return done.stdout + done.stderr

    return carry_out


EXCLUDED = {
    'starts a process': "import subprocess\ndef test_a(): subprocess.run(['true'])\n",
    'forks': 'import os\ndef test_a():\n    if os.fork() == 0: os._exit(0)\n    os.wait()\n',
    'sleeps in test_a.py': 'import time\ndef test_a(): time.sleep(0.0)\n',
    'reads the wall clock in test_a.py': 'import time\ndef test_a(): time.monotonic()\n',
    'its file took': (
        'import time\n'
        'def test_a():\n'
        '    end_s = time.process_time() + 1.01\n'
        '    while time.process_time() < end_s: pass\n'
    ),
}


@pytest.mark.parametrize('what', EXCLUDED)
def test_a_fast_test_that_needs_another_tier_fails(run: Run, what: str) -> None:
    files = {'tests/test_a.py': EXCLUDED[what]}
    found = run(files, '--fast-tier')
    assert what in found
    assert '1 failed' in found
    assert '1 passed' in run(files)


def test_the_clock_is_watched_where_a_module_has_bound_it(run: Run) -> None:
    text = 'from time import time\ndef test_a(): time()\n'
    assert 'reads the wall clock' in run({'tests/test_a.py': text}, '--fast-tier')


def test_a_library_may_read_the_clock_and_a_test_may_measure_what_a_step_takes(run: Run) -> None:
    text = (
        'import logging, time\n'
        'def test_a():\n'
        "    logging.getLogger().error('it has the time of the wall clock')\n"
        '    assert time.perf_counter() <= time.perf_counter()\n'
    )
    assert '1 passed' in run({'tests/test_a.py': text}, '--fast-tier')


def test_a_test_with_a_marker_is_left_out(run: Run) -> None:
    text = (
        'import time, pytest\n'
        '@pytest.mark.slow\n'
        'def test_a(): time.sleep(0.0)\n'
        'def test_b(): pass\n'
    )
    found = run({'tests/test_a.py': text}, '--fast-tier')
    assert '1 passed, 1 deselected' in found


@pytest.mark.parametrize('options', [(), ('--fast-tier',)])
def test_nightly_tests_run_alone(run: Run, options: tuple[str, ...]) -> None:
    text = 'def test_a(): pass\n'
    files = {'tests/test_b.py': text, 'tests/nightly/test_a.py': text}
    assert 'test_a.py::test_a is nightly: run tests/nightly alone' in run(files, *options)
    assert '1 passed' in run(files, '--ignore=tests/nightly', *options)
    if not options:
        assert '1 passed' in run(files, 'tests/nightly')


@pytest.mark.parametrize('target', ['test', 'test-fast'])
def test_make_selects_no_nightly_test(target: str) -> None:
    lines = (ROOT / 'Makefile').read_text(encoding='utf-8').splitlines()
    begin = next(place for place, line in enumerate(lines) if line.startswith(f'{target}:'))
    recipe = ' '.join(lines[begin : begin + 3])
    assert 'pytest' in recipe
    assert '--ignore=$(NIGHTLY)' in recipe
