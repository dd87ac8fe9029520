# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Keep floors out of the user's cache, let Ctrl-C work, and let the suite take less time."""

import gc
import os
import shutil
import signal
import tempfile
from pathlib import Path

import hypothesis
import pytest

# Before any test imports numpy: it chooses the kernel of linear algebra.
import ddct_plant  # noqa: F401

pytest_plugins = ['tiers']
VARIABLE = 'DDCT_CACHE'
"""That of `ddct_plant.files.cache_folder`."""
_FOLDER = pytest.StashKey[Path]()
# On a busy machine any example may take long.
hypothesis.settings.register_profile(
    'busy', deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow]
)
hypothesis.settings.load_profile('busy')
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # So it is in the background of a shell, and the programs that tests start would inherit it.
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_configure(config: pytest.Config) -> None:
    """Make the folder; the processes of pytest-xdist use that of the first one."""
    if not hasattr(config, 'workerinput'):
        config.stash[_FOLDER] = Path(tempfile.mkdtemp(prefix='ddct-floors-'))
        os.environ[VARIABLE] = str(config.stash[_FOLDER])


def pytest_unconfigure(config: pytest.Config) -> None:
    """Remove the folder."""
    if _FOLDER in config.stash:
        shutil.rmtree(config.stash[_FOLDER], ignore_errors=True)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """
    Put the files with slow tests and a browser first: none is left to one worker at the end.

    That needs `--no-loadscope-reorder`: else pytest-xdist begins with the files of most tests.
    """
    slow = {item.path for item in items if any(map(item.get_closest_marker, ('slow', 'browser')))}
    items.sort(key=lambda item: (item.path not in slow, item.path))


def pytest_collection(session: pytest.Session) -> None:
    """
    Search for no garbage meanwhile: next to nothing that is loaded is.

    Of two workers one begins with the other half of the folders. So in a fresh clone each of them
    compiles half of the tests, and finds the others compiled.
    """
    gc.disable()
    worker = getattr(session.config, 'workerinput', {}).get('workerid', 'gw0')
    if int(worker.removeprefix('gw')) % 2:
        arguments = session.config.args
        half = len(arguments) // 2
        session.config.args = arguments[half:] + arguments[:half]


def pytest_collection_finish() -> None:
    """Exempt what is loaded by now from later searches for garbage, and have few of them."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)
    gc.enable()


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """Exempt what a file has loaded too: each graph of the next ones would search it."""
    if nextitem is not None and nextitem.path != item.path:
        gc.collect()
        gc.freeze()
