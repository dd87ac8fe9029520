# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Small programs in place of nodes."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest


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
