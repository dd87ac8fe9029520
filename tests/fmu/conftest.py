# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Common parts of the tests of FMUs."""

from pathlib import Path

import pytest
from support.fmu import skip_without_fmus


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an empty folder, which is the present one; temporary files go into its `tmp`."""
    skip_without_fmus()
    monkeypatch.chdir(tmp_path)
    Path('tmp').mkdir()
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path / 'tmp'))
    monkeypatch.setenv('TMPDIR', str(tmp_path / 'tmp'))
    return tmp_path
