# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A log of another car with its column map, in a folder."""

from pathlib import Path

import pytest
from support.other_car import COLUMNS, drive, write_csv


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with `drive.csv` and its column map `map.yaml`."""
    (tmp_path / 'map.yaml').write_text(COLUMNS)
    write_csv(tmp_path / 'drive.csv', 3, drive(1))
    return tmp_path
