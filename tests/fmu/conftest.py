"""What the tests of FMUs share."""

import shutil
from pathlib import Path

import pytest


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an empty folder, which is the present one; temporary files go into its `tmp`."""
    pytest.importorskip('fmpy', reason='FMPy, an optional extra, is absent: make fmu')
    if shutil.which('cc') is None:
        pytest.skip('there is no C compiler cc')
    monkeypatch.chdir(tmp_path)
    Path('tmp').mkdir()
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path / 'tmp'))
    return tmp_path
