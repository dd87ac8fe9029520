# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Plugin of pytest for `make test-fast`: it selects the fast tests, and fails one that is not.

A fast test starts no process, does not fork, does not sleep and does not read the wall clock, and
a file of them takes a second of processor time. What needs more has a marker (CONTRIBUTING.md), or
is in tests/nightly, which neither `make test` nor `make test-fast` may select.
"""

import contextlib
import importlib
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

OPTION = '--fast-tier'
MARKERS = ('browser', 'compiler', 'graph', 'nightly', 'process', 'slow')
"""Markers of what the fast tier leaves out."""
NIGHTLY = Path('tests', 'nightly')
"""Folder of the tests that only `make test-nightly` runs."""
EXCLUDED = {
    'os.fork': 'forks',
    'os.forkpty': 'forks',
    'os.posix_spawn': 'starts a process',
    'subprocess.Popen': 'starts a process',
}
"""Audit events of Python, and what a test does that raises one."""
WATCHED = {
    **dict.fromkeys(('monotonic', 'monotonic_ns', 'time', 'time_ns'), 'reads the wall clock'),
    'sleep': 'sleeps',
}
"""
Functions of `time`, and what a test does that calls one; Python 3.11 has no audit event of them.

`perf_counter` is none: it only measures how long something took.
"""
IMPORTED = ('bokeh.plotting', 'control', 'matplotlib.backends.backend_agg', 'pandas')
"""Libraries that tests import late, for a second: their time is not that of the first file."""
MOST_S = 1.0
"""Most processor time of the tests of a file, s."""
_ADVICE = f'give it a marker of {", ".join(MARKERS)}, or move it to tests/nightly'


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that selects the tier."""
    parser.addoption(OPTION, action='store_true', help='run the fast tests alone, and check them')


def pytest_configure(config: pytest.Config) -> None:
    """Watch the tests of the tier."""
    if config.getoption(OPTION):
        config.pluginmanager.register(FastTier(config.rootpath))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Refuse to run nightly tests together with those of another tier."""
    folder = config.rootpath / NIGHTLY
    files = {path for path in {item.path for item in items} if folder in path.parents}
    nightly = [item for item in items if item.path in files]
    if nightly and (config.getoption(OPTION) or len(nightly) < len(items)):
        raise pytest.UsageError(
            f'{nightly[0].nodeid} is nightly: run {NIGHTLY} alone, the others with '
            f'--ignore={NIGHTLY}'
        )


class FastTier:
    """Selects and watches the fast tests of this process."""

    def __init__(self, root: Path) -> None:
        """Start to listen; Python cannot remove a hook of its audit events."""
        self._root = root
        self._running = False
        self._done: set[str] = set()
        self._taken_s: dict[Path, float] = defaultdict(float)
        self._patches = pytest.MonkeyPatch()
        sys.addaudithook(self._on_event)
        # Before the tests are imported, as these and the product may bind the functions.
        for name, what in WATCHED.items():
            self._patches.setattr(time, name, self._watched(getattr(time, name), what))

    def _on_event(self, event: str, _arguments: tuple[Any, ...]) -> None:
        if self._running and event in EXCLUDED:
            self._done.add(EXCLUDED[event])

    def _watched(self, function: Callable[..., float], what: str) -> Callable[..., float]:
        """Return a function of `time` that notes when a test or the product calls it."""

        def call(*arguments: float) -> float:
            if self._running:
                caller = Path(sys._getframe(1).f_code.co_filename)
                if self._root in caller.parents and 'site-packages' not in caller.parts:
                    self._done.add(f'{what} in {caller.name}')
            return function(*arguments)

        return call

    def pytest_unconfigure(self) -> None:
        """Put the functions of `time` back."""
        self._patches.undo()

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(
        self, config: pytest.Config, items: list[pytest.Item]
    ) -> None:
        """Leave out the tests that have a marker."""
        others = [item for item in items if any(map(item.get_closest_marker, MARKERS))]
        config.hook.pytest_deselected(items=others)
        left_out = {*others}
        items[:] = [item for item in items if item not in left_out]

    def pytest_collection_finish(self) -> None:
        """Import what the tests of this process import late."""
        for name in IMPORTED:
            with contextlib.suppress(ImportError):
                importlib.import_module(name)

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
