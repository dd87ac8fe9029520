# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Small programs in place of nodes."""

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from stub_programs import Start
from waiting import WITHIN_S

from ddct_bringup.processes import fork_server
from ddct_bringup.processes.fork_server import start_processes, stop_server
from ddct_bringup.processes.forked import Forked
from ddct_plant.program.supervision import Patience


@pytest.fixture(scope='module')
def small_server() -> Iterator[None]:
    """Let a fork server that starts import no nodes, which takes it a second."""
    here, path = str(Path(__file__).parent), os.environ.get('PYTHONPATH', '')
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('PYTHONPATH', f'{here}{os.pathsep}{path}')
        patch.setattr(fork_server, '_PRELOADED', 'small_preload')
        yield
    stop_server()


@pytest.fixture
def module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], str]:
    """Return a function that writes a module, for all forks, and returns its name."""
    folder = tmp_path / 'path'
    folder.mkdir()
    monkeypatch.setattr(sys, 'path', [str(folder), *sys.path])

    def write(text: str) -> str:
        name = f'{tmp_path.name}_{len(list(folder.iterdir()))}'
        (folder / f'{name}.py').write_text(text)
        return name

    return write


@pytest.fixture
def start(module: Callable[[str], str]) -> Iterator[Start]:
    """Return a function that starts a text as a program; it is killed at the end."""
    with ExitStack() as started:

        def fork(text: str, *arguments: str, patience: Patience | None = None) -> Forked:
            forked = Forked(module(text), *arguments, patience=patience)
            started.callback(forked.close)
            start_processes([forked.process])
            forked.begin()
            started.callback(forked.send, signal.SIGKILL)
            return forked

        yield fork


@pytest.fixture
def run(start: Start) -> Start:
    """Return a function that runs a text as a program to its end."""

    def to_its_end(text: str, *arguments: str) -> Forked:
        forked = start(text, *arguments)
        assert forked.wait(WITHIN_S)
        return forked

    return to_its_end
