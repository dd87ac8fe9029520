# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The tiers are kept apart: `make test-fast` fails a test of another, none runs a nightly one."""

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
import samples
from tiers import IMPORTED, MARKERS

pytestmark = pytest.mark.process

ROOT = Path(__file__).parents[2]
Run = Callable[..., str]


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Return a function that runs tests in a project with the plugin, and returns its output."""
    for name in IMPORTED:  # empty ones take no seconds
        (tmp_path / name.partition('.')[0]).with_suffix('.py').touch()
    (tmp_path / 'pyproject.toml').write_text(
        '[tool.pytest.ini_options]\nmarkers = ["slow"]\naddopts = "-p tiers -p no:cacheprovider"\n'
    )
    (tmp_path / 'conftest.py').write_text('import tiers\n\ntiers.MOST_S = 0.2\n')

    def carry_out(texts: dict[str, str], *options: str) -> str:
        for name, text in texts.items():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(text)
        done = subprocess.run(
            [sys.executable, '-m', 'pytest', '-q', '-rA', *options],
            cwd=tmp_path,
            env={
                **os.environ,
                'PYTHONPATH': str(ROOT / 'tests' / 'plugins'),
                'PYTEST_DISABLE_PLUGIN_AUTOLOAD': '1',
                'COLUMNS': '200',
            },
            capture_output=True,
            text=True,
            check=False,
        )
        return done.stdout + done.stderr

    return carry_out


EXCLUDED = {
    'process': "import subprocess\ndef test_a(): subprocess.run(['true'])\n",
    'fork': 'import os\ndef test_a():\n    if os.fork() == 0: os._exit(0)\n    os.wait()\n',
    'sleep': 'import time\ndef test_a(): time.sleep(0.0)\n',
    'clock': 'import time\ndef test_a(): time.monotonic()\n',
    'bound_clock': 'from time import time\ndef test_a(): time()\n',
    'long': (
        'import tiers, time\n'
        'def test_a():\n'
        '    end_s = time.process_time() + tiers.MOST_S + 0.01\n'
        '    while time.process_time() < end_s: pass\n'
    ),
}
"""Tests of other tiers, by the names of their files."""
REASONS = {
    'process': 'starts a process',
    'fork': 'forks',
    'sleep': 'sleeps in test_sleep.py',
    'clock': 'reads the wall clock in test_clock.py',
    'bound_clock': 'reads the wall clock in test_bound_clock.py',
    'long': 'its file took',
}
ALLOWED = {
    'library': (
        'import logging, time\n'
        'def test_a():\n'
        "    logging.getLogger().error('it has the time of the wall clock')\n"
        '    assert time.perf_counter() <= time.perf_counter()\n'
    ),
    'marked': (
        'import time, pytest\n'
        '@pytest.mark.slow\n'
        'def test_a(): time.sleep(0.0)\n'
        'def test_b(): pass\n'
    ),
}
"""Fast tests, and one whose marker leaves it out."""


def test_a_fast_test_that_needs_another_tier_fails_with_the_reason(run: Run) -> None:
    texts = {**EXCLUDED, **ALLOWED}
    files = {f'tests/test_{name}.py': text for name, text in texts.items()}
    found = run(files, '--fast-tier')
    assert '6 failed, 2 passed, 1 deselected' in found
    for name, reason in REASONS.items():
        (line,) = re.findall(f'^FAILED tests/test_{name}.py.*', found, re.MULTILINE)
        assert reason in line
    assert 'PASSED tests/test_library.py::test_a' in found
    assert 'PASSED tests/test_marked.py::test_b' in found
    assert '9 passed' in run(files)


def test_nightly_tests_run_alone(run: Run) -> None:
    text = 'def test_a(): pass\n'
    files = {'tests/test_b.py': text, 'tests/nightly/test_a.py': text}
    refusal = 'test_a.py::test_a is nightly: run tests/nightly alone'
    assert refusal in run(files)
    assert refusal in run(files, '--fast-tier')
    assert '1 passed' in run(files, '--fast-tier', '--ignore=tests/nightly')
    assert '1 passed' in run(files, 'tests/nightly')


@pytest.mark.parametrize('target', ['test', 'test-fast'])
def test_make_selects_no_nightly_test(target: str) -> None:
    lines = (ROOT / 'Makefile').read_text(encoding='utf-8').splitlines()
    begin = next(place for place, line in enumerate(lines) if line.startswith(f'{target}:'))
    recipe = ' '.join(lines[begin : begin + 3])
    assert 'pytest' in recipe
    assert '--ignore=$(NIGHTLY)' in recipe
    assert f"-m 'not {samples.NIGHTLY}'" in recipe or '--fast-tier' in recipe


def test_a_sample_of_many_cases_stays_and_the_others_are_nightly() -> None:
    cases = samples.sampled([('a', 1), ('b', 2), 'c'], every=2)
    assert [case.values for case in cases] == [('a', 1), ('b', 2), ('c',)]
    assert [[mark.name for mark in case.marks] for case in cases] == [[], ['nightly'], []]
    assert samples.NIGHTLY in MARKERS, 'the fast tier leaves them out'
