"""A run that is interrupted at its very end is interrupted."""

import os
import signal

import pytest

from ddct_bringup.run import execution
from ddct_bringup.run.plan import RunPlan
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

PLAN = RunPlan(RunSettings(load_scenario('thesis')), 'pi', 'headless')


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_that_comes_when_the_run_has_ended_is_not_forgotten(
    monkeypatch, tmp_path, number
):
    monkeypatch.setattr(execution, 'execute', lambda *_: os.kill(os.getpid(), number))
    with pytest.raises(KeyboardInterrupt):
        execution.run_with_progress(PLAN, tmp_path)


def test_a_run_that_nobody_interrupts_says_how_long_it_took(monkeypatch, tmp_path, capfd):
    monkeypatch.setattr(execution, 'execute', lambda *_: None)
    execution.run_with_progress(PLAN, tmp_path)
    assert 'pi: 3 s of thesis in ' in capfd.readouterr().err
