# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Logs in MAT files are read as CSV is; what reads MDF files is asked for in one line."""

import sys
from pathlib import Path

import numpy as np
import pytest
import scipy
from refusals import refused

from ddct_bringup.logs.columns import ColumnMap, LogColumn
from ddct_bringup.logs.log import read_log
from ddct_plant.base.errors import DdctError

COLUMNS = ColumnMap(
    {'time': LogColumn(('log.t',), 's'), 'engine_speed': LogColumn(('log.n',), 'rpm')}, {}
)
TIMES = np.arange(5) * 0.01


def written(folder: Path, speeds: np.ndarray) -> Path:
    """Write a MAT file with a structure of two vectors, a scalar and a text."""
    log = {'t': TIMES[:, None], 'n': speeds[:, None], 'driver': 'A', 'gear': 1.0}
    scipy.io.savemat(folder / 'drive.mat', {'log': log})
    return folder / 'drive.mat'


def test_vectors_in_a_structure_have_dots_in_their_names(tmp_path: Path) -> None:
    log = read_log(written(tmp_path, 1000.0 + np.arange(5)), COLUMNS, ('engine_speed',))
    np.testing.assert_allclose(log.time_s, TIMES)
    expected = (1000.0 + np.arange(5)) * np.pi / 30
    np.testing.assert_allclose(log.signals['engine_speed'], expected, rtol=1e-12)


def test_what_is_no_log_in_a_mat_file_is_refused_with_its_name(tmp_path: Path) -> None:
    with pytest.raises(DdctError, match='log.n has 4 values and log.t 5'):
        read_log(written(tmp_path, np.ones(4)), COLUMNS)
    with pytest.raises(
        DdctError, match='row 3, column log.n: engine_speed is .* is it in another'
    ):
        read_log(written(tmp_path, np.array([1, 1, 1e5, 1, 1])), COLUMNS)
    (tmp_path / 'drive.mat').write_bytes(b'MATLAB 7.3 MAT-file'.ljust(124) + b'\x00\x02IM')
    with pytest.raises(
        DdctError, match=r'drive\.mat: a MAT file of version 7.3: save it with -v7'
    ):
        read_log(tmp_path / 'drive.mat', COLUMNS)
    (tmp_path / 'drive.mat').write_bytes(b'no MAT file' * 20)
    with pytest.raises(DdctError, match=r'drive\.mat: it is no MAT file'):
        read_log(tmp_path / 'drive.mat', COLUMNS)


def test_an_mdf_file_without_asammdf_asks_for_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, 'asammdf', None)
    with refused(DdctError, place='drive.mf4') as caught:
        read_log(tmp_path / 'drive.mf4', COLUMNS)
    assert 'pip install asammdf' in str(caught.value)
