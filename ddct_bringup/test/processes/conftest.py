# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Small programs in place of nodes, and the warm parent that forks them."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from ddct_bringup.processes.warm_parent import WarmParent


@pytest.fixture(scope='module')
def stubs(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """
    Return the folder of the programs, on the path of every process that the tests start.

    These processes also have the variable `AT_THE_START`.
    """
    folder = tmp_path_factory.mktemp('path')
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('PYTHONPATH', f'{folder}:{os.environ.get("PYTHONPATH", "")}')
        patch.setenv('AT_THE_START', 'yes')
        yield folder


@pytest.fixture(scope='module')
def parent(stubs: Path) -> Iterator[WarmParent]:
    """Return a warm parent for all tests of a module."""
    with WarmParent() as started:
        yield started
