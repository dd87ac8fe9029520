# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run that is interrupted at its very end is interrupted."""

import os
import signal

import pytest

from ddct_bringup.run import execution
from ddct_bringup.run.plan import RunPlan
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

PLAN = RunPlan(RunSettings(KnownSettings(load_scenario('thesis'))), 'pi', 'headless')


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_after_the_end_of_the_run_still_interrupts_it(monkeypatch, tmp_path, number):
    monkeypatch.setattr(execution, 'execute', lambda *_: os.kill(os.getpid(), number))
    with pytest.raises(KeyboardInterrupt):
        execution.run_with_progress(PLAN, tmp_path)


def test_a_run_without_interruption_prints_its_wall_time(monkeypatch, tmp_path, capfd):
    monkeypatch.setattr(execution, 'execute', lambda *_: None)
    execution.run_with_progress(PLAN, tmp_path)
    assert 'pi: 3 s of thesis in ' in capfd.readouterr().err
