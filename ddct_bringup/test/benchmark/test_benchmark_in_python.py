# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A benchmark from Python writes its folder, and is a table."""

from pathlib import Path

import numpy as np
import pytest
from small_benchmark import use_small_release
from small_tuning import leave_out_pictures

from ddct_bringup.api import DdctError, benchmark, document
from ddct_bringup.benchmark.file_names import RESULT
from ddct_bringup.evaluation.quantities import MAIN
from ddct_plant.files.json_records import json_text

pytestmark = pytest.mark.slow
GAIN = """\
name: gain
units: {input: rpm, output: N m}
polynomial: {num: [-0.1], den: [1.0]}
discretisation: hold
"""


def test_the_table_has_the_shares_and_medians_of_the_result_in_its_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out_pictures(monkeypatch)
    use_small_release(tmp_path, monkeypatch)
    (tmp_path / 'gain.yaml').write_text(GAIN, encoding='utf-8')
    found = benchmark(str(tmp_path / 'gain.yaml'), tmp_path / 'mine', workers=1)
    written = (tmp_path / 'mine' / RESULT).read_text(encoding='utf-8')
    assert json_text(found.result) == written
    assert list(found.table.index) == ['gain', 'pi', 'ls8']
    (judged,) = found.result.controllers
    names = ('gain', 'pi', 'ls8')
    for part, summary in (
        ('development', found.result.development),
        ('held_out', judged.held_out),
    ):
        groups = [each for each in summary.groups if each.controller in names]
        assert [each.controller for each in groups] == [*names]
        for each in groups:
            row = found.table.loc[each.controller]
            assert row[f'{part}.success'] == each.engaged.value
            for name in MAIN:
                median = each.quantities[name].quantiles.p50
                shown = row[f'{part}.{name}']
                assert np.isnan(shown) if median is None else shown == median
    assert found.page.is_file()
    assert document(tmp_path / 'mine').title in found.page.read_text(encoding='utf-8')


def test_an_unknown_controller_is_refused_before_a_folder_is_made(tmp_path: Path) -> None:
    with pytest.raises(DdctError, match='nobody'):
        benchmark('nobody', tmp_path / 'out')
    assert not (tmp_path / 'out').exists()
