# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A log of another car with its column map, in a folder; fits without their progress."""

import math
from pathlib import Path

import pytest
from support.other_car import COLUMNS, drive, write_csv

from ddct_plant.program import progress


@pytest.fixture(autouse=True)
def no_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have no progress printed: on a busy machine a fit takes long enough for it."""
    monkeypatch.setattr(progress, '_QUIET_S', math.inf)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with `drive.csv` and its column map `map.yaml`."""
    (tmp_path / 'map.yaml').write_text(COLUMNS)
    write_csv(tmp_path / 'drive.csv', 3, drive(1))
    return tmp_path
