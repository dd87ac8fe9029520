# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Helper processes of the browser may end a little after it, and must end."""

import os
import subprocess
import sys
import uuid
from collections.abc import Iterator

import pytest
from report.browser_processes import MARK, wait_for_helpers
from support.processes import processes_left

Helpers = list['subprocess.Popen[bytes]']


@pytest.fixture
def helpers() -> Iterator[Helpers]:
    """Return a list of processes that are ended after the test."""
    started: Helpers = []
    yield started
    for helper in started:
        with helper:
            helper.kill()


@pytest.fixture
def mark() -> str:
    """Return a mark of this test alone: two copies of the suite can run on one machine."""
    return uuid.uuid4().hex


def start(helpers: Helpers, mark: str, program: str) -> int:
    """Start a helper in a separate session, like the crash handler."""
    helper = subprocess.Popen(
        [sys.executable, '-c', f"print('ready', flush=True)\n{program}"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        start_new_session=True,
        env={**os.environ, MARK: mark},
    )
    helpers.append(helper)
    # Popen returns before the kernel has given the new program its environment.
    assert helper.stdout is not None
    assert helper.stdout.readline() == b'ready\n'
    return helper.pid


def test_a_helper_that_ends_a_little_after_the_browser_is_waited_for(
    helpers: Helpers, mark: str
) -> None:
    pid = start(helpers, mark, 'import sys, time; sys.stdin.read(); time.sleep(0.3)')
    assert pid in processes_left()
    (browser,) = (helper.stdin for helper in helpers)
    assert browser is not None
    browser.close()
    assert wait_for_helpers(mark) == []
    assert pid not in processes_left(), 'what each test is asked at its end'


def test_a_helper_that_stays_is_not_passed_over(helpers: Helpers, mark: str) -> None:
    pid = start(helpers, mark, 'import sys; sys.stdin.read()')
    assert wait_for_helpers(mark, 0.2) == [pid]
    assert pid in processes_left(), 'so the test that started it fails'


def test_helpers_of_another_browser_are_not_waited_for(helpers: Helpers, mark: str) -> None:
    start(helpers, mark, 'import sys; sys.stdin.read()')
    assert wait_for_helpers(f'another than {mark}') == []
