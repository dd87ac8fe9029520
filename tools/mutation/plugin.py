# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plugin of pytest for the mutation runner: a context for each test, durations, a given order."""

import json
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from mutation import tracing

ORDER = 'DDCT_TEST_ORDER'
"""Environment variable: file with the ids of the tests to run, one a line, in this order."""
PROGRESS = 'DDCT_TEST_PROGRESS'
"""Environment variable: file that has the id of the running test."""
SETUP = ' (setup)'


def pytest_configure(config: pytest.Config) -> None:
    """Read the order before anything is collected."""
    config.stash[_ORDER] = {}
    if file := os.environ.get(ORDER):
        lines = Path(file).read_text(encoding='utf-8').splitlines()
        config.stash[_ORDER] = {name: place for place, name in enumerate(lines)}


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_collection_modifyitems(
    config: pytest.Config, items: list[pytest.Item]
) -> Iterator[None]:
    """Sort after all other plugins have sorted, and leave out what is not in the order."""
    yield
    if order := config.stash[_ORDER]:
        items[:] = sorted(
            (item for item in items if item.nodeid in order), key=lambda i: order[i.nodeid]
        )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Write which test runs; leave what runs between tests without a context."""
    if file := os.environ.get(PROGRESS):
        Path(file).write_text(item.nodeid, encoding='utf-8')
    yield
    _switch('')


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Name fixtures apart: one of a module is made in one test and used by others."""
    _switch(item.nodeid + SETUP)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_call(item: pytest.Item) -> None:
    """Name the test."""
    _switch(item.nodeid)


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Append the duration to a file beside the records."""
    if tracing.FOLDER in os.environ and 'PYTEST_XDIST_WORKER' not in os.environ:
        folder = Path(os.environ[tracing.FOLDER])
        graph = 'graph' in report.keywords
        entry = [report.nodeid, report.outcome, report.duration, graph]
        with (folder / 'durations.jsonl').open('a', encoding='utf-8') as file:
            file.write(json.dumps(entry) + '\n')


def _switch(context: str) -> None:
    if (recorder := tracing.recorder()) is not None:
        recorder.coverage.switch_context(context)


_ORDER = pytest.StashKey[dict[str, int]]()
