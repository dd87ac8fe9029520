# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Keep the floors that tests compute out of the user's cache: one folder for the session."""

import os
import shutil
import tempfile
from pathlib import Path

import pytest

from ddct_bringup.floor.cache import VARIABLE

_FOLDER = pytest.StashKey[Path]()


def pytest_configure(config: pytest.Config) -> None:
    """Make the folder; the processes of pytest-xdist use that of the first one."""
    if not hasattr(config, 'workerinput'):
        config.stash[_FOLDER] = Path(tempfile.mkdtemp(prefix='ddct-floors-'))
        os.environ[VARIABLE] = str(config.stash[_FOLDER])


def pytest_unconfigure(config: pytest.Config) -> None:
    """Remove the folder."""
    if _FOLDER in config.stash:
        shutil.rmtree(config.stash[_FOLDER], ignore_errors=True)
