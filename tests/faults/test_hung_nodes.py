# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A node that hangs in a run is named itself, and not the driveline that waits for it."""

from dataclasses import replace
from pathlib import Path

import pytest
from samples import sampled
from support.processes import processes_left
from support.runs import plan

from ddct_bringup.processes import supervisor
from ddct_bringup.run.execution import execute
from ddct_plant.base.errors import DdctError
from ddct_plant.program.supervision import Patience

HANGING = """
import time

from ddct_controllers.interface import Command, Controller


class Hanging(Controller):
    def reset(self):
        pass

    def update(self, measurement):
        while measurement.step == 65:
            {}
        return Command(0.0)
"""


@pytest.mark.parametrize(
    'work',
    sampled(['sum(range(10**15))', 'time.sleep(600.0)'], every=2),
    ids=['with the lock', 'without the lock'],
)
def test_a_controller_that_hangs_is_named_and_its_log_shows_where(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, work: str
) -> None:
    file, folder = tmp_path / 'hanging.py', tmp_path / 'run'
    file.write_text(HANGING.format(work), encoding='utf-8')
    folder.mkdir()
    monkeypatch.setattr(supervisor, 'PATIENCE', Patience(silent_s=2.0))
    with pytest.raises(DdctError) as raised:
        execute(replace(plan(), controller=str(file)), folder)
    log = folder / 'work' / 'controller.log'
    words = 'node controller hung and ended itself, its stacks are in its log'
    assert str(raised.value) == f'{words}; its log is {log}'
    assert 'hanging.py", line 13 in update' in log.read_text(encoding='utf-8')
    assert not processes_left()
