# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller in an FMU runs in the nodes as headless, and leaves no file of its own behind."""

from pathlib import Path

import numpy as np
import pytest
from support.fmu import GAINS, controller_file, skip_without_fmus
from support.runs import LAYOUTS, bag_bytes, expected, plan, record


@pytest.mark.compiler
def test_an_fmu_gives_the_same_bytes_in_each_layout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    skip_without_fmus()
    monkeypatch.chdir(tmp_path)
    Path('tmp').mkdir()
    monkeypatch.setenv('TMPDIR', str(tmp_path / 'tmp'))
    file = controller_file(3, ('Ki: 0.3', 'Ki: 0.9'))
    changes = (GAINS, 'controllers.mine.pid_Ki=0.3')
    bags = []
    for layout in LAYOUTS:
        recording = record(plan(file, layout, changes=changes), tmp_path / layout)
        assert recording.run_info['/controller']['controller'] == 'mine'
        pi = expected(plan('pi', changes=changes))
        assert np.array_equal(recording.trajectory.torque_request, pi.torque_request)
        bags.append(bag_bytes(tmp_path / layout))
    assert bags[0] == bags[1] == bags[2]
    assert list(Path('tmp').glob('ddct_fmu_*')) == []
