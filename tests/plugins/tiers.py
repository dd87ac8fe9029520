# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Plugin of pytest for `make test-fast`: it selects the fast tests, and fails one that is not.

A fast test starts no process, does not fork and does not sleep, and a file of them takes a second
of processor time. What needs more has a marker (CONTRIBUTING.md), or is in tests/nightly.
"""

import sys
import time
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

OPTION = '--fast-tier'
MARKERS = ('browser', 'compiler', 'graph', 'process', 'slow')
"""Markers of what the fast tier leaves out."""
EXCLUDED = {
    'os.fork': 'forks',
    'os.forkpty': 'forks',
    'os.posix_spawn': 'starts a process',
    'subprocess.Popen': 'starts a process',
    'time.sleep': 'sleeps',
}
"""Audit events of Python, and what a test does that raises one."""
MOST_S = 2.0
"""Most processor time of a file, s: twice the second that is allowed, for slow machines."""
_ADVICE = f'give it a marker of {", ".join(MARKERS)}, or move it to tests/nightly'


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that selects the tier."""
    parser.addoption(OPTION, action='store_true', help='run the fast tests alone, and check them')


def pytest_configure(config: pytest.Config) -> None:
    """Watch the tests of the tier."""
    if config.getoption(OPTION):
        config.pluginmanager.register(FastTier())


class FastTier:
    """Selects and watches the fast tests of this process."""

    def __init__(self) -> None:
        """Start to listen; Python cannot remove a hook of its audit events."""
        self._running = False
        self._done: set[str] = set()
        self._taken_s: dict[Path, float] = defaultdict(float)
        sys.addaudithook(self._on_event)

    def _on_event(self, event: str, _arguments: tuple[Any, ...]) -> None:
        if self._running and event in EXCLUDED:
            self._done.add(EXCLUDED[event])

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(
        self, config: pytest.Config, items: list[pytest.Item]
    ) -> None:
        """Leave out the tests that have a marker."""
        others = [item for item in items if any(map(item.get_closest_marker, MARKERS))]
        config.hook.pytest_deselected(items=others)
        left_out = {*others}
        items[:] = [item for item in items if item not in left_out]

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Iterator[None]:
        """Fail a test that does what its tier excludes."""
        self._running, self._done = True, set()
        start_s = time.process_time()
        try:
            yield
        finally:
            self._running = False
            self._taken_s[item.path] += time.process_time() - start_s
        if self._done:
            pytest.fail(f'it {", ".join(sorted(self._done))}: {_ADVICE}', pytrace=False)
        if (taken_s := self._taken_s[item.path]) > MOST_S:
            pytest.fail(f'its file took {taken_s:.1f} s so far: {_ADVICE}', pytrace=False)
